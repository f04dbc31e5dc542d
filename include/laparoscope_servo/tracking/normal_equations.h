// ESM's normal equations by moments.
//
// A row of ESM's Jacobian is linear in the image gradient, with coefficients that are polynomials in the normalised template
// coordinates (u, v):
//   J = [gx, gy, gx v, gy u, gx u - gy v, g3 - gy v, g3 u, g3 v],  g3 = -(u gx + v gy)
// so J'WJ and J'Wr are sums of moments sum w {gx^2, gx gy, gy^2} u^a v^b (a + b <= 4) and sum w {gx, gy} r u^a v^b (a + b <= 2).
// v is constant in a row of the template: rows are summed in float over u^a, and weighted with v^b once a row, in double.
#pragma once

#include <Eigen/Core>

#include "laparoscope_servo/tracking/tracker_config.h"

namespace laparoscope_servo::tracking {

// Order of the unknowns: x_1 .. x_8 of sl(3), then the changes of gain and bias.
using Matrix10d = Eigen::Matrix<double, 10, 10>;
using Vector10d = Eigen::Matrix<double, 10, 1>;

// The eight entries of J for one pixel, as above. Reference for tests, and readable beside the papers.
Eigen::Matrix<double, 1, 8> esmJacobianRow(double gx, double gy, double u, double v);

// One row of pixels, all arrays of `count`.
struct PixelRow {
  int count = 0;
  double v = 0.0;            // normalised coordinate of the row
  float u0 = 0.0f;           // normalised coordinate of pixel 0
  float du = 0.0f;           // and its growth from pixel to pixel
  const float* gx = nullptr;        // gradients per normalised unit, averaged over template and image
  const float* gy = nullptr;
  const float* residual = nullptr;  // gain * image + bias - template
  const float* intensity = nullptr; // (image + template) / 2, the derivative for the gain
  const float* weight = nullptr;    // >= 0
};

class NormalEquations {
 public:
  // Starts a sum. Blocks follow: rows of pixels, then endBlock().
  void reset(Light light);
  void add(const PixelRow& row);
  // Adds the rows since the last call. With Light::kLocal the block's own bias is eliminated: what remains are the equations
  // of the other unknowns at the bias that is best for them.
  void endBlock();

  // J'WJ and J'Wr of all blocks. Unknowns that `light` does not have get a row of the identity, and 0.
  const Matrix10d& matrix() const { return matrix_; }
  const Vector10d& vector() const { return vector_; }
  // sum w of the last block, sum w r, and sum w J: the best bias of a block after a step x changes by -(sum w r + sum w J x) / sum w.
  double blockWeight() const { return block_weight_; }
  double blockResidual() const { return block_residual_; }
  const Vector10d& blockJacobian() const { return block_jacobian_; }

 private:
  static constexpr int kSecond = 15;  // monomials u^a v^b with a + b <= 4
  static constexpr int kFirst = 6;    // and with a + b <= 2
  struct Sums {
    double xx[kSecond], xy[kSecond], yy[kSecond];
    double xr[kFirst], yr[kFirst];  // gradient times residual
    double xm[kFirst], ym[kFirst];  // gradient times intensity
    double x1[kFirst], y1[kFirst];  // gradient
    double w, m, mm, r, mr;
  };
  Sums sums_ = {};
  Light light_ = Light::kConstant;
  Matrix10d matrix_ = Matrix10d::Identity();
  Vector10d vector_ = Vector10d::Zero();
  Vector10d block_jacobian_ = Vector10d::Zero();
  double block_weight_ = 0.0;
  double block_residual_ = 0.0;
};

}  // namespace laparoscope_servo::tracking
