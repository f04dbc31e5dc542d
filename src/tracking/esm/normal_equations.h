// ESM's normal equations from sums over cells of a few pixels.
//
// A row of ESM's Jacobian is linear in the image gradient, with coefficients that are polynomials in the normalised
// template coordinates (u, v):
//   J = [gx, gy, gx v, gy u, gx u - gy v, g3 - gy v, g3 u, g3 v],  g3 = -(u gx + v gy)
// so J'WJ and J'Wr are sums of {gx^2, gx gy, gy^2} and {gx, gy} r times monomials in u and v. The gradient changes from
// pixel to pixel, the monomials hardly do: pixels are summed over cells of up to 16 x 8, and the monomials taken at the
// cell's centre. J'WJ and J'Wr are then those of one and the same slightly different Jacobian, so that the iteration
// converges to an unbiased estimate; with cells of one pixel they are exact.
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

// Half the ROI's larger side [px]: the unit of the normalised template coordinates, whose origin is the ROI's centre. N
// takes pixels of the reference to them.
double halfSize(const geometry::Rectangle& roi);
Eigen::Matrix3d templateFromPixels(const geometry::Rectangle& roi);

// px of the image: the unit of lengths that scale with the region, such as how far it moves and how far tissue deviates
// from a plane. They were measured on films in regions with a larger side of 60 to 340 px, where the unit is 1 px. It
// grows in proportion for a larger region, or for the same region in an image with more pixels.
double lengthUnit(const geometry::Rectangle& roi);

// The eight entries of J for one pixel, as above. Used as the reference in tests; written as in the papers.
Eigen::Matrix<double, 1, 8> esmJacobianRow(double gx, double gy, double u, double v);
// Derivative by x of the point exp(A(x)) p, in normalised template units: esmJacobianRow() for the two unit gradients.
Eigen::Matrix<double, 2, 8> pointJacobian(const Eigen::Vector2d& p);

// Weighted sums over a cell of products of the gradient (gx, gy), the residual r and the intensity m.
struct CellSums {
  float xx, xy, yy;  // products of the gradient with itself
  float xr, yr;      // products of gradient and residual
  float x, y;        // gradient
  float xm, ym;      // products of gradient and intensity (image + template) / 2, the derivative for the gain
  float w, r;        // weight, residual
  float m, mm, mr;   // intensity, its square, its product with the residual
};

class NormalEquations {
 public:
  // Starts a sum. For each block, call addCell() for its cells, then endBlock(). `gradient_scale` takes the cells'
  // gradients to normalised units.
  void reset(Light light, double gradient_scale);
  // (u, v): normalised template coordinates of the cell's centre.
  void addCell(const CellSums& cell, double u, double v);
  // Ends the block of the cells since the last call. With Light::kLocal the block's own bias is eliminated, which
  // leaves the equations of the other unknowns (Schur complement).
  void endBlock();

  // J'WJ and J'Wr of all blocks. Unknowns that `light` does not have get a row of the identity, and 0.
  Matrix10d matrix() const;
  const Vector10d& vector() const { return vector_; }
  // Sums of the last block that ended: sum w, sum w r, and sum w J; see LightBlockSums.
  double blockWeight() const { return block_weight_; }
  double blockResidual() const { return block_residual_; }
  const Vector10d& blockJacobian() const { return block_jacobian_; }
  // The last block's contribution to vector().
  Vector10d blockScore() const { return vector_ - vector_before_; }

 private:
  static constexpr int kSecond = 15;  // number of monomials u^a v^b with a + b <= 4
  struct Moments {
    double xx[kSecond], xy[kSecond], yy[kSecond];
  };
  Moments moments_ = {};  // sums over all cells
  Light light_ = Light::kConstant;
  double gradient_scale_ = 1.0;
  Matrix10d matrix_ = Matrix10d::Identity();
  Vector10d gain_column_ = Vector10d::Zero();  // column of matrix_ for the gain, without the parts that blocks subtract
  Vector10d vector_ = Vector10d::Zero();
  Vector10d vector_before_ = Vector10d::Zero();  // vector_ without the last block
  Vector10d block_jacobian_ = Vector10d::Zero();
  double block_weight_ = 0.0;
  double block_residual_ = 0.0;
  bool block_open_ = false;
};

// Sums of one block of a plane, see NormalEquations: weight, weighted residual, weighted Jacobian, and its part of
// J'Wr.
struct LightBlockSums {
  double weight;
  double residual;
  Vector10d jacobian;
  Vector10d score;

  // Change of the block's own bias, which was eliminated, by a step `x` of all else: what that leaves of the mean
  // residual. The weight must not be 0.
  double biasStep(const Vector10d& x) const { return -(residual + jacobian.dot(x)) / weight; }
};

class LevelEquations {
 public:
  // Sums the equations of the level's warped image, at the biases of its planes. `light`: which unknowns of the
  // illumination there are. `rejection` [grey levels]: residuals from which Tukey's weights are 0; 0 gives all
  // residuals full weight.
  void sum(const EsmLevel& level, const geometry::Rectangle& roi, Light light, double gain, double rejection);

  Matrix10d matrix() const { return equations_.matrix(); }
  const Vector10d& vector() const { return equations_.vector(); }
  const std::vector<LightBlockSums>& blocks() const { return blocks_; }  // plane by plane, row by row
  // Plane by plane, row by row, as many in a row as the patch has strips times cells_per_strip; those beyond the patch
  // are empty. Their gradients are those of sumCells().
  const std::vector<CellSums>& cells() const { return cells_; }

 private:
  void sumLightBlockRow(const EsmLevel& level, const Eigen::Matrix3d& unit_T_patch, const CellInput& input,
                        const EsmPlane& plane, int block_row);

  NormalEquations equations_;
  std::vector<LightBlockSums> blocks_;
  std::vector<float> strip_bias_;
  std::vector<CellSums> cells_;
  std::size_t next_cell_ = 0;  // of the next row of blocks
};

// Solves symmetric equations whose unknowns have different units (grey levels, normalised coordinates): the matrix is
// scaled to a unit diagonal first.
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
