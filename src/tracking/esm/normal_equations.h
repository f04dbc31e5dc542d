// ESM's normal equations from sums over cells of a few pixels.
//
// A row of ESM's Jacobian is linear in the image gradient, with coefficients that are polynomials in the normalised
// template coordinates (u, v):
//   J = [gx, gy, gx v, gy u, gx u - gy v, g3 - gy v, g3 u, g3 v],  g3 = -(u gx + v gy)
// so J'WJ and J'Wr are sums of {gx^2, gx gy, gy^2} and {gx, gy} r times monomials in u and v. The gradient changes from
// pixel to pixel, the monomials hardly do: pixels are summed over cells of up to 16 x 8, and the monomials taken at the
// cell's centre. J'WJ and J'Wr are then those of one and the same slightly different Jacobian, so that what the
// iteration converges to has no bias; with cells of one pixel they are exact.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "tracking/esm/esm_level.h"

namespace laparoscope_servo::tracking {

struct CellInput;

// Order of the unknowns: x_1 .. x_8 of sl(3), then the changes of gain and bias.
using Matrix10d = Eigen::Matrix<double, 10, 10>;
using Vector10d = Eigen::Matrix<double, 10, 1>;
using Matrix8d = Eigen::Matrix<double, 8, 8>;

// N takes pixels of the reference to normalised template coordinates: their origin is the ROI's centre, their unit half
// its larger side [px].
double halfSize(const geometry::Rectangle& roi);
Eigen::Matrix3d templateFromPixels(const geometry::Rectangle& roi);

// px of the image, the unit of lengths that grow with a region: how far it moves, what a plane cannot follow. They were
// measured on films, in regions whose larger side is 60 to 340 px, where the unit is 1. In a larger region, or the same
// one in an image with more pixels, it grows in proportion.
double lengthUnit(const geometry::Rectangle& roi);

// The eight entries of J for one pixel, as above. Reference for tests, and readable beside the papers.
Eigen::Matrix<double, 1, 8> esmJacobianRow(double gx, double gy, double u, double v);
// The derivative by x of where exp(A(x)) takes the point p, all in normalised template units: rows for unit gradients.
Eigen::Matrix<double, 2, 8> pointJacobian(const Eigen::Vector2d& p);

// Sums over a cell of the weight times: products of the gradient (gx, gy), the residual r and the intensity m.
struct CellSums {
  float xx, xy, yy;  // gradient with itself
  float xr, yr;      // gradient with residual
  float x, y;        // gradient
  float xm, ym;      // gradient with intensity: (image + template) / 2, the derivative for the gain
  float w, r;        // weight, residual
  float m, mm, mr;   // intensity, with itself, with residual
};

class NormalEquations {
 public:
  // Starts a sum. Blocks follow: cells, then endBlock(). Gradients in cells count `gradient_scale` times, which brings
  // them to normalised units.
  void reset(Light light, double gradient_scale);
  // (u, v): normalised template coordinates of the cell's centre.
  void addCell(const CellSums& cell, double u, double v);
  // Ends the cells since the last call. With Light::kLocal the block's own bias is eliminated: what remains are the
  // equations of the other unknowns at the bias that is best for them.
  void endBlock();

  // J'WJ and J'Wr of all blocks. Unknowns that `light` does not have get a row of the identity, and 0.
  Matrix10d matrix() const;
  const Vector10d& vector() const { return vector_; }
  // Of the last block that ended: sum w, sum w r, and sum w J. The bias of the block after a step x changes by -(sum w
  // r + sum w J x) / sum w.
  double blockWeight() const { return block_weight_; }
  double blockResidual() const { return block_residual_; }
  const Vector10d& blockJacobian() const { return block_jacobian_; }
  // What the block added to vector().
  Vector10d blockScore() const { return vector_ - vector_before_; }

 private:
  static constexpr int kSecond = 15;  // monomials u^a v^b with a + b <= 4
  struct Moments {
    double xx[kSecond], xy[kSecond], yy[kSecond];
  };
  Moments moments_ = {};  // of all cells
  Light light_ = Light::kConstant;
  double gradient_scale_ = 1.0;
  Matrix10d matrix_ = Matrix10d::Identity();
  Vector10d gain_column_ = Vector10d::Zero();  // of matrix_, apart from what blocks subtract
  Vector10d vector_ = Vector10d::Zero();
  Vector10d vector_before_ = Vector10d::Zero();  // without the last block
  Vector10d block_jacobian_ = Vector10d::Zero();
  double block_weight_ = 0.0;
  double block_residual_ = 0.0;
  bool block_open_ = false;
};

// What a block of a plane adds, see NormalEquations: its weight, weighted residual and Jacobian, and its part of J'Wr.
struct LightBlockSums {
  double weight;
  double residual;
  Vector10d jacobian;
  Vector10d score;
};

class LevelEquations {
 public:
  // Those of the level's image as it is warped now, with the biases that its planes have. `light`: what of the light is
  // unknown. `rejection` [grey levels]: residuals from which on Tukey's weights are 0; 0 gives every residual its full
  // weight.
  void sum(const EsmLevel& level, const geometry::Rectangle& roi, Light light, double gain, double rejection);

  Matrix10d matrix() const { return equations_.matrix(); }
  const Vector10d& vector() const { return equations_.vector(); }
  const std::vector<LightBlockSums>& blocks() const { return blocks_; }  // plane by plane, row by row

 private:
  void sumLightBlockRow(const EsmLevel& level, const Eigen::Matrix3d& unit_T_patch, const CellInput& input,
                        const EsmPlane& plane, int block_row);

  NormalEquations equations_;
  std::vector<LightBlockSums> blocks_;
  std::vector<float> strip_bias_;
  std::vector<CellSums> cells_;  // of a block row: cell rows times strips
};

// Solves symmetric equations whose unknowns have different units: the matrix has its diagonal divided out, as grey
// levels and normalised coordinates have nothing to do with each other.
template <int N>
class Factors {
 public:
  using Matrix = Eigen::Matrix<double, N, N>;
  // `a`: symmetric, positive semidefinite.
  explicit Factors(const Matrix& a)
      : d_(a.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse()), ldlt_(d_.asDiagonal() * a * d_.asDiagonal()) {}
  // 0 for a singular matrix, 1 for a diagonal one.
  double conditioning() const { return ldlt_.info() == Eigen::Success ? ldlt_.vectorD().minCoeff() : 0.0; }
  template <typename Right>
  auto solve(const Right& b) const {
    return (d_.asDiagonal() * ldlt_.solve(d_.asDiagonal() * b)).eval();
  }

 private:
  Eigen::Matrix<double, N, 1> d_;
  Eigen::LDLT<Matrix> ldlt_;
};

}  // namespace laparoscope_servo::tracking
