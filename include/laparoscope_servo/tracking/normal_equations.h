// ESM's normal equations by moments.
//
// A row of ESM's Jacobian is linear in the image gradient, with coefficients that are polynomials in the normalised template
// coordinates (u, v):
//   J = [gx, gy, gx v, gy u, gx u - gy v, g3 - gy v, g3 u, g3 v],  g3 = -(u gx + v gy)
// so J'WJ and J'Wr are sums of moments sum w {gx^2, gx gy, gy^2} u^a v^b (a + b <= 4) and sum w {gx, gy} r u^a v^b (a + b <= 2).
// v is constant in a row of the template: rows are summed in float over u^a, and weighted with v^b once a row, in double.
#pragma once

#include <Eigen/Core>

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
  void reset();
  // Illumination costs about twice as much: without it the last two unknowns are left out, and their block is the identity.
  void add(const PixelRow& row, bool illumination);

  // J'WJ and J'Wr of everything added since reset().
  Matrix10d matrix() const;
  Vector10d vector() const;
  double weightSum() const { return sums_.w; }
  // sum w r^2
  double cost() const { return sums_.rr; }

 private:
  static constexpr int kSecond = 15;  // monomials u^a v^b with a + b <= 4
  static constexpr int kFirst = 6;    // and with a + b <= 2
  struct Sums {
    double xx[kSecond], xy[kSecond], yy[kSecond];
    double xr[kFirst], yr[kFirst];  // gradient times residual
    double xm[kFirst], ym[kFirst];  // gradient times intensity
    double x1[kFirst], y1[kFirst];  // gradient
    double w, m, mm, r, mr, rr;
  };
  Sums sums_ = {};
  bool illumination_ = false;
};

}  // namespace laparoscope_servo::tracking
