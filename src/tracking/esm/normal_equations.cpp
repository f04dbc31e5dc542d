#include "tracking/esm/normal_equations.h"

#include <algorithm>
#include <array>

#include "tracking/esm/esm_kernels.h"

namespace laparoscope_servo::tracking {

namespace {

// c * u^a v^b
struct Monomial {
  double c;
  int a;
  int b;
};

// J_k = gx P_k(u, v) + gy Q_k(u, v)
constexpr std::array<Monomial, 8> kP = {
    {{1, 0, 0}, {0, 0, 0}, {1, 0, 1}, {0, 0, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, 2, 0}, {-1, 1, 1}}};
constexpr std::array<Monomial, 8> kQ = {
    {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 1, 0}, {-1, 0, 1}, {-2, 0, 1}, {-1, 1, 1}, {-1, 0, 2}}};

double product(const Monomial& s, const Monomial& t, const double* moments) {
  const double c = s.c * t.c;
  return c == 0.0 ? 0.0 : c * moments[CellMoments::indexOf(s.a + t.a, s.b + t.b)];
}

// The order of CellSums' members.
enum Sum { kXX, kXY, kYY, kXR, kYR, kX, kY, kXM, kYM, kW, kR, kM, kMM, kMR };

// The sum of the rows of J for the gradients of which the moments are `x` and `y`, times `scale`.
Vector10d rowOf(const CellMoments& moments, Sum x, Sum y, double scale) {
  const auto times = [&](Sum sum, int a, int b) { return moments.low[CellMoments::indexOf(a, b)][sum]; };
  Vector10d row;
  row << times(x, 0, 0), times(y, 0, 0), times(x, 0, 1), times(y, 1, 0), times(x, 1, 0) - times(y, 0, 1),
      -times(x, 1, 0) - 2.0 * times(y, 0, 1), -times(x, 2, 0) - times(y, 1, 1), -times(x, 1, 1) - times(y, 0, 2), 0.0,
      0.0;
  return scale * row;
}

}  // namespace

double halfSize(const geometry::Rectangle& roi) {
  return std::max(roi.width, roi.height) / 2.0;
}

double lengthUnit(const geometry::Rectangle& roi) {
  constexpr double kMeasured = 340.0;  // px, larger side of the largest region on which lengths were measured
  return std::max(1.0, std::max(roi.width, roi.height) / kMeasured);
}

Eigen::Matrix3d templateFromPixels(const geometry::Rectangle& roi) {
  const double unit = halfSize(roi);
  Eigen::Matrix3d n;
  n << 1.0 / unit, 0.0, -roi.centre().x() / unit,  //
      0.0, 1.0 / unit, -roi.centre().y() / unit,   //
      0.0, 0.0, 1.0;
  return n;
}

Eigen::Matrix<double, 1, 8> esmJacobianRow(double gx, double gy, double u, double v) {
  const double g3 = -(u * gx + v * gy);
  Eigen::Matrix<double, 1, 8> j;
  j << gx, gy, gx * v, gy * u, gx * u - gy * v, g3 - gy * v, g3 * u, g3 * v;
  return j;
}

Eigen::Matrix<double, 2, 8> pointJacobian(const Eigen::Vector2d& p) {
  Eigen::Matrix<double, 2, 8> j;
  j.row(0) = esmJacobianRow(1.0, 0.0, p.x(), p.y());
  j.row(1) = esmJacobianRow(0.0, 1.0, p.x(), p.y());
  return j;
}

void NormalEquations::reset(Light light, double gradient_scale) {
  *this = NormalEquations();
  light_ = light;
  gradient_scale_ = gradient_scale;
  matrix_.setZero();
}

void NormalEquations::addCells(const CellSums* cells, int stride, int count, double u, const double* v) {
  addMoments(cells, stride, count, u, v, block_);
}

void NormalEquations::endBlock() {
  const double f = gradient_scale_;
  for (int k = 0; k < kMonomials; ++k) {
    const double* const sums = k < CellMoments::kLow ? block_.low[k] : block_.high[k - CellMoments::kLow];
    products_.xx[k] += f * f * sums[kXX];
    products_.xy[k] += f * f * sums[kXY];
    products_.yy[k] += f * f * sums[kYY];
  }
  const double* const sums = block_.low[0];
  block_weight_ = sums[kW];
  block_residual_ = sums[kR];
  block_score_ = rowOf(block_, kXR, kYR, f);
  if (light_ != Light::kConstant) {
    gain_column_ += rowOf(block_, kXM, kYM, f);
    matrix_(8, 8) += sums[kMM];
    block_score_[8] = sums[kMR];
    block_jacobian_ = rowOf(block_, kX, kY, f);
    block_jacobian_[8] = sums[kM];
  }
  if (light_ == Light::kGlobal) {
    matrix_.col(9).head<9>() += block_jacobian_.head<9>();
    matrix_(9, 9) += block_weight_;
    block_score_[9] = block_residual_;
  } else if (light_ == Light::kLocal && block_weight_ > 0.0) {
    for (int k = 0; k < 9; ++k) {
      matrix_.col(k).head(k + 1) -= block_jacobian_[k] / block_weight_ * block_jacobian_.head(k + 1);
    }
    block_score_.head<9>() -= block_jacobian_.head<9>() * (block_residual_ / block_weight_);
  }
  vector_ += block_score_;
  block_ = CellMoments();
}

Matrix10d NormalEquations::matrix() const {
  Matrix10d m = matrix_;
  m.col(8).head<8>() += gain_column_.head<8>();
  for (int k = 0; k < 8; ++k) {
    for (int l = k; l < 8; ++l) {
      m(k, l) += product(kP[k], kP[l], products_.xx) + product(kP[k], kQ[l], products_.xy) +
                 product(kQ[k], kP[l], products_.xy) + product(kQ[k], kQ[l], products_.yy);
    }
  }
  if (light_ == Light::kConstant) m(8, 8) = 1.0;
  if (light_ != Light::kGlobal) m(9, 9) = 1.0;
  return m.selfadjointView<Eigen::Upper>();
}

void LevelEquations::sum(const EsmLevel& level, const geometry::Rectangle& roi, Light light, double gain,
                         double rejection) {
  CellInput input;
  input.weight = &level.usedWeight();
  input.gain = static_cast<float>(gain);
  input.inverse_rejection = rejection > 0.0 ? static_cast<float>(1.0 / rejection) : 0.0f;
  // The kernel adds both gradients; J needs their mean, per normalised unit.
  const Eigen::Matrix3d unit_T_patch = templateFromPixels(roi) * level.image_T_patch;
  equations_.reset(light, 0.5 * halfSize(roi) / level.scale);
  blocks_.clear();
  next_cell_ = 0;
  for (const EsmPlane& plane : level.planes) {
    input.image = &plane.warped;
    input.reference = &plane.value;
    for (int row = 0; row + 1 < static_cast<int>(level.light_row_begin.size()); ++row) {
      sumLightBlockRow(level, unit_T_patch, input, plane, row);
    }
  }
}

void LevelEquations::sumLightBlockRow(const EsmLevel& level, const Eigen::Matrix3d& unit_T_patch,
                                      const CellInput& input, const EsmPlane& plane, int block_row) {
  const int begin = level.light_row_begin[block_row];
  const int end = level.light_row_begin[block_row + 1];
  const int cell_rows = (end - begin + level.cell_rows - 1) / level.cell_rows;
  const int strips = level.weight.strips();
  strip_bias_.resize(strips);
  for (int strip = 0; strip < strips; ++strip) {
    const std::size_t block = block_row * level.light_columns + level.light_column_of_strip[strip];
    strip_bias_[strip] = static_cast<float>(plane.biasOf(block, input.gain));
  }
  const int per_strip = level.cells_per_strip;
  const std::size_t first_cell = next_cell_;
  next_cell_ += static_cast<std::size_t>(cell_rows) * strips * per_strip;
  cells_.resize(std::max(cells_.size(), next_cell_));
  CellSums* const cells = cells_.data() + first_cell;
  for (int k = 0; k < cell_rows; ++k) {
    const int row = begin + k * level.cell_rows;
    sumCells(input, row, std::min(level.cell_rows, end - row), per_strip, strip_bias_.data(),
             cells + k * strips * per_strip);
  }
  row_centres_.clear();
  for (int k = 0; k < cell_rows; ++k) {
    const int row = begin + k * level.cell_rows;
    const int rows = std::min(level.cell_rows, end - row);
    row_centres_.push_back(unit_T_patch(1, 2) + unit_T_patch(1, 1) * (row + 0.5 * (rows - 1)));
  }
  const int cell_columns = image::Patch::kStrip / per_strip;
  for (int strip = 0; strip < strips; ++strip) {
    for (int cell = strip * per_strip; cell < (strip + 1) * per_strip; ++cell) {
      const int columns = std::min(cell_columns, level.width - cell * cell_columns);
      if (columns <= 0) break;
      const double u = unit_T_patch(0, 2) + unit_T_patch(0, 0) * (cell * cell_columns + 0.5 * (columns - 1));
      equations_.addCells(cells + cell, strips * per_strip, cell_rows, u, row_centres_.data());
    }
    if (strip + 1 < strips && level.light_column_of_strip[strip + 1] == level.light_column_of_strip[strip]) continue;
    equations_.endBlock();
    blocks_.push_back(
        {equations_.blockWeight(), equations_.blockResidual(), equations_.blockJacobian(), equations_.blockScore()});
  }
}

}  // namespace laparoscope_servo::tracking
