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

// Index of the moment of u^a v^b; monomials are ordered by a, then by b.
constexpr int indexOfDegree4(int a, int b) {
  return a * 5 - a * (a - 1) / 2 + b;
}

double product(const Monomial& s, const Monomial& t, const double* moments) {
  const double c = s.c * t.c;
  return c == 0.0 ? 0.0 : c * moments[indexOfDegree4(s.a + t.a, s.b + t.b)];
}

// Adds the row of J for the gradient (gx, gy).
inline void addRow(double gx, double gy, double u, double v, Vector10d& sum) {
  const double g3 = -(u * gx + v * gy);
  sum[0] += gx;
  sum[1] += gy;
  sum[2] += gx * v;
  sum[3] += gy * u;
  sum[4] += gx * u - gy * v;
  sum[5] += g3 - gy * v;
  sum[6] += g3 * u;
  sum[7] += g3 * v;
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
  Vector10d j = Vector10d::Zero();
  addRow(gx, gy, u, v, j);
  return j.head<8>().transpose();
}

Eigen::Matrix<double, 2, 8> pointJacobian(const Eigen::Vector2d& p) {
  Eigen::Matrix<double, 2, 8> j;
  j.row(0) = esmJacobianRow(1.0, 0.0, p.x(), p.y());
  j.row(1) = esmJacobianRow(0.0, 1.0, p.x(), p.y());
  return j;
}

void NormalEquations::reset(Light light, double gradient_scale) {
  light_ = light;
  gradient_scale_ = gradient_scale;
  moments_ = {};
  matrix_.setZero();
  vector_.setZero();
  gain_column_.setZero();
  block_jacobian_.setZero();
  block_weight_ = block_residual_ = 0.0;
  block_open_ = false;
}

void NormalEquations::addCell(const CellSums& cell, double u, double v) {
  if (!block_open_) {
    block_jacobian_.setZero();
    block_weight_ = block_residual_ = 0.0;
    vector_before_ = vector_;
    block_open_ = true;
  }
  const double f = gradient_scale_;
  double u_power = 1.0;
  for (int a = 0; a <= 4; ++a, u_power *= u) {
    double power = f * f * u_power;  // u^a v^b
    for (int b = 0; a + b <= 4; ++b, power *= v) {
      const int k = indexOfDegree4(a, b);
      moments_.xx[k] += power * cell.xx;
      moments_.xy[k] += power * cell.xy;
      moments_.yy[k] += power * cell.yy;
    }
  }
  addRow(f * cell.xr, f * cell.yr, u, v, vector_);
  block_weight_ += cell.w;
  block_residual_ += cell.r;
  if (light_ == Light::kConstant) return;
  addRow(f * cell.xm, f * cell.ym, u, v, gain_column_);
  matrix_(8, 8) += cell.mm;
  vector_[8] += cell.mr;
  addRow(f * cell.x, f * cell.y, u, v, block_jacobian_);
  block_jacobian_[8] += cell.m;
}

void NormalEquations::endBlock() {
  block_open_ = false;
  if (light_ == Light::kGlobal) {
    matrix_.col(9).head<9>() += block_jacobian_.head<9>();
    matrix_(9, 9) += block_weight_;
    vector_[9] += block_residual_;
  } else if (light_ == Light::kLocal && block_weight_ > 0.0) {
    matrix_.topLeftCorner<9, 9>() -=
        block_jacobian_.head<9>() * (block_jacobian_.head<9>() / block_weight_).transpose();
    vector_.head<9>() -= block_jacobian_.head<9>() * (block_residual_ / block_weight_);
  }
}

Matrix10d NormalEquations::matrix() const {
  Matrix10d m = matrix_;
  m.col(8).head<8>() += gain_column_.head<8>();
  for (int k = 0; k < 8; ++k) {
    for (int l = k; l < 8; ++l) {
      m(k, l) += product(kP[k], kP[l], moments_.xx) + product(kP[k], kQ[l], moments_.xy) +
                 product(kQ[k], kP[l], moments_.xy) + product(kQ[k], kQ[l], moments_.yy);
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
  const int cell_columns = image::Patch::kStrip / per_strip;
  for (int strip = 0; strip < strips; ++strip) {
    for (int cell = strip * per_strip; cell < (strip + 1) * per_strip; ++cell) {
      const int columns = std::min(cell_columns, level.width - cell * cell_columns);
      if (columns <= 0) break;
      const double u = unit_T_patch(0, 2) + unit_T_patch(0, 0) * (cell * cell_columns + 0.5 * (columns - 1));
      for (int k = 0; k < cell_rows; ++k) {
        const int row = begin + k * level.cell_rows;
        const int rows = std::min(level.cell_rows, end - row);
        const double v = unit_T_patch(1, 2) + unit_T_patch(1, 1) * (row + 0.5 * (rows - 1));
        equations_.addCell(cells[k * strips * per_strip + cell], u, v);
      }
    }
    if (strip + 1 < strips && level.light_column_of_strip[strip + 1] == level.light_column_of_strip[strip]) continue;
    equations_.endBlock();
    blocks_.push_back(
        {equations_.blockWeight(), equations_.blockResidual(), equations_.blockJacobian(), equations_.blockScore()});
  }
}

}  // namespace laparoscope_servo::tracking
