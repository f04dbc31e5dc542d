#include "laparoscope_servo/tracking/esm.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "esm_kernels.h"
#include "laparoscope_servo/geometry/sl3.h"
#include "laparoscope_servo/image/warp.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kMinLevelSide = 8;        // px
constexpr double kTukey = 4.6851;       // 95 % efficiency for normal noise (Marchand and Chaumette 2004, appendix)
constexpr double kMadToSigma = 1.4826;  // normal noise
constexpr double kMinSigma = 1.0;       // grey levels; below it quantisation is mistaken for outliers
constexpr int kMaxSamples = 1024;        // of the residual, for its scale

Eigen::Matrix3d scaling(double s, double x, double y) {
  Eigen::Matrix3d m;
  m << s, 0.0, x,  //
      0.0, s, y,   //
      0.0, 0.0, 1.0;
  return m;
}

// The derivative of the corner's image, in normalised template units, at the identity: the rows of J for unit gradients.
Eigen::Matrix<double, 2, 8> cornerJacobian(double u, double v) {
  Eigen::Matrix<double, 2, 8> j;
  j.row(0) = esmJacobianRow(1.0, 0.0, u, v);
  j.row(1) = esmJacobianRow(0.0, 1.0, u, v);
  return j;
}

// Blocks of light are about a twelfth of the ROI, to follow its shading, and at least a strip, to leave the texture's own contrast
// to the motion.
constexpr int kLightBlocksAlong = 12;

// Begins of about equal parts of `size`, each a multiple of `unit` but for the last, as many as fit with at least `least` each.
std::vector<int> split(int size, int unit, int least) {
  const int parts = std::clamp((size + least / 2) / least, 1, kLightBlocksAlong);
  std::vector<int> begins;
  for (int k = 0; k < parts; ++k) {
    const int begin = (k * size / parts + unit / 2) / unit * unit;
    if (begins.empty() || begin > begins.back()) begins.push_back(begin);
  }
  begins.push_back(size);
  return begins;
}

// Of three rows, the least in each column, then of three columns around each second one.
void leastOfNeighbours(const image::Patch& fine, const cv::Point& offset, std::vector<float>& row, image::Patch& coarse) {
  const int width = fine.width();
  row.resize(width + 2);
  for (int j = 0; j < coarse.height(); ++j) {
    const int centre = std::min(2 * j + offset.y, fine.height() - 1);
    const float* a = fine.row(std::max(centre - 1, 0));
    const float* b = fine.row(centre);
    const float* c = fine.row(std::min(centre + 1, fine.height() - 1));
    float* least = row.data() + 1;
    for (int i = 0; i < width; ++i) least[i] = std::min(std::min(a[i], b[i]), c[i]);
    least[-1] = least[0];
    least[width] = least[width - 1];
    float* to = coarse.row(j);
    for (int i = 0; i < coarse.width(); ++i) {
      const int k = std::min(2 * i + offset.x, width - 1);
      to[i] = std::min(std::min(least[k - 1], least[k]), least[k + 1]);
    }
  }
}

void copy(const cv::Mat1f& from, image::Patch& to) {
  to.resize(from.cols, from.rows);
  for (int j = 0; j < from.rows; ++j) std::copy_n(from.ptr<float>(j), from.cols, to.row(j));
}

}  // namespace

void Esm::setReference(const image::RegionPyramid& reference, const geometry::Rectangle& roi) {
  roi_ = roi;
  half_size_ = std::max(roi.width, roi.height) / 2.0;
  n_ = scaling(1.0 / half_size_, -roi.centre().x() / half_size_, -roi.centre().y() / half_size_);
  n_inv_ = n_.inverse();
  levels_.clear();
  forgetLight();
  // Without a lens the levels' pixels are taken as they are; with one they are sampled anyway, from the ROI's first on.
  const int x = lens_ ? 0 : static_cast<int>(roi.x) - reference.origin().x;
  const int y = lens_ ? 0 : static_cast<int>(roi.y) - reference.origin().y;
  const int right = x + static_cast<int>(roi.width) - 1;
  const int bottom = y + static_cast<int>(roi.height) - 1;
  for (int l = 0; l < std::min(config_.levels, reference.levels()); ++l) {
    const int size = 1 << l;
    const cv::Point begin((x + size - 1) / size, (y + size - 1) / size);
    const cv::Point end(right / size, bottom / size);
    const cv::Rect patch(begin, cv::Size(end.x - begin.x + 1, end.y - begin.y + 1));
    if (l > 0 && std::min(patch.width, patch.height) < kMinLevelSide) break;
    EsmLevel level;
    level.weight.resize(patch.width, patch.height);
    level.weight.view().setTo(1.0f);
    level.used.resize(patch.width, patch.height);
    level.warped.resize(patch.width, patch.height);
    level.valid.resize(patch.width, patch.height);
    level.scale = size;
    level.first = begin * size - cv::Point(x, y);
    level.image_T_patch = scaling(size, roi.x + level.first.x, roi.y + level.first.y);
    takeReference(reference, l, patch, level);
    image::gradients(level.value, level.gx, level.gy);
    // Cells of an eighth of the patch or less: the Jacobian's polynomials hardly change within.
    level.cells_per_strip = patch.width >= 128 ? 1 : patch.width >= 64 ? 2 : 4;
    level.cell_rows = patch.height >= 128 ? kMaxCellRows : patch.height >= 64 ? kMaxCellRows / 2 : kMaxCellRows / 4;
    planLight(level);
    levels_.push_back(std::move(level));
  }
}

void Esm::takeReference(const image::RegionPyramid& reference, int l, const cv::Rect& patch, EsmLevel& level) const {
  if (!lens_) {
    copy(reference.level(l)(patch), level.value);
    return;
  }
  copy(image::rectify(reference.level(l), level.image_T_patch, *lens_, {reference.origin(), level.scale}, patch.size()),
       level.value);
}

void Esm::planLight(EsmLevel& level) const {
  const std::vector<int> columns = split(level.value.width(), image::Patch::kStrip, image::Patch::kStrip);
  level.block_row_begin = split(level.value.height(), kMaxCellRows, image::Patch::kStrip);
  level.block_columns = static_cast<int>(columns.size()) - 1;
  level.block_of_strip.resize(level.value.strips());
  for (int strip = 0; strip < level.value.strips(); ++strip) {
    const auto next = std::upper_bound(columns.begin(), columns.end() - 1, strip * image::Patch::kStrip);
    level.block_of_strip[strip] = static_cast<int>(next - columns.begin()) - 1;
  }
  level.bias.assign(level.block_columns * (level.block_row_begin.size() - 1), 0.0);
}

void Esm::setWeights(const cv::Mat1f& weights) {
  copy(weights, levels_[0].weight);
  for (std::size_t l = 1; l < levels_.size(); ++l) {
    const EsmLevel& fine = levels_[l - 1];
    leastOfNeighbours(fine.weight, (levels_[l].first - fine.first) / static_cast<int>(fine.scale), samples_, levels_[l].weight);
  }
}

void Esm::warp(const image::RegionPyramid& current, EsmLevel& level, int l, const Eigen::Matrix3d& g) {
  const double size = level.scale;
  if (lens_) {
    level.all_valid = image::warpBilinear(current.level(l), g * level.image_T_patch, *lens_, {current.origin(), size},
                                          level.warped, level.valid);
  } else {
    const Eigen::Matrix3d level_T_image = scaling(1.0 / size, -current.origin().x / size, -current.origin().y / size);
    level.all_valid =
        image::warpBilinear(current.level(l), level_T_image * g * level.image_T_patch, level.warped, level.valid);
  }
  level.warped.extrapolate();
  if (level.all_valid) return;
  // A pixel beside one that is not valid has no gradient.
  cv::Mat1f valid = level.valid.view();
  cv::erode(valid.clone(), valid, cv::getStructuringElement(cv::MORPH_CROSS, cv::Size(3, 3)));
  cv::Mat1f used = level.used.view();
  cv::multiply(level.weight.view(), valid, used);
}

void Esm::forgetLight() { light_known_ = false; }

void Esm::startLight(EsmLevel& level, const EsmState& state) {
  const image::Patch& weight = level.all_valid ? level.weight : level.used;
  std::vector<double> sums(level.bias.size(), 0.0), weights(level.bias.size(), 0.0);
  for (std::size_t block_row = 0; block_row + 1 < level.block_row_begin.size(); ++block_row) {
    for (int j = level.block_row_begin[block_row]; j < level.block_row_begin[block_row + 1]; ++j) {
      for (int i = 0; i < level.value.width(); ++i) {
        const std::size_t block = block_row * level.block_columns + level.block_of_strip[i / image::Patch::kStrip];
        sums[block] += weight(j, i) * (level.value(j, i) - state.gain * level.warped(j, i));
        weights[block] += weight(j, i);
      }
    }
  }
  for (std::size_t block = 0; block < sums.size(); ++block) {
    level.bias[block] = weights[block] > 0.0 && config_.light == Light::kLocal ? sums[block] / weights[block] : state.bias;
  }
}

double Esm::residualScale(const EsmLevel& level, const EsmState& state) {
  samples_.clear();
  const image::Patch& weight = level.all_valid ? level.weight : level.used;
  const int pixels = level.value.width() * level.value.height();
  const int stride = std::max(1, pixels / kMaxSamples);
  const float gain = static_cast<float>(state.gain);
  std::size_t block_row = 0;
  for (int j = 0; j < level.value.height(); ++j) {
    if (j >= level.block_row_begin[block_row + 1]) ++block_row;
    const double* bias = level.bias.data() + block_row * level.block_columns;
    // A stride along the rows that starts elsewhere in each row, so that no pattern of the image is preferred.
    for (int i = (j * 7) % stride; i < level.value.width(); i += stride) {
      if (!(weight(j, i) > 0.0f)) continue;
      const float b = static_cast<float>(bias[level.block_of_strip[i / image::Patch::kStrip]]);
      samples_.push_back(std::abs(gain * level.warped(j, i) + b - level.value(j, i)));
    }
  }
  if (samples_.empty()) return kMinSigma;
  const auto middle = samples_.begin() + static_cast<std::ptrdiff_t>(samples_.size() / 2);
  std::nth_element(samples_.begin(), middle, samples_.end());
  return std::max(kMinSigma, kMadToSigma * static_cast<double>(*middle));
}

void Esm::accumulate(const EsmLevel& level, const EsmState& state, double sigma) {
  CellInput input;
  input.image = &level.warped;
  input.reference = &level.value;
  input.reference_gx = &level.gx;
  input.reference_gy = &level.gy;
  input.weight = level.all_valid ? &level.weight : &level.used;
  input.gain = static_cast<float>(state.gain);
  input.inverse_rejection = config_.robust ? static_cast<float>(1.0 / (kTukey * sigma)) : 0.0f;
  // The kernel adds both gradients; J takes their mean, per normalised unit.
  equations_.reset(config_.light, 0.5 * half_size_ / level.scale);
  const Eigen::Matrix3d unit_T_patch = n_ * level.image_T_patch;
  const int strips = level.value.strips();
  strip_bias_.resize(strips);
  block_sums_.clear();
  for (std::size_t block_row = 0; block_row + 1 < level.block_row_begin.size(); ++block_row) {
    const int begin = level.block_row_begin[block_row];
    const int end = level.block_row_begin[block_row + 1];
    const int cell_rows = (end - begin + level.cell_rows - 1) / level.cell_rows;
    for (int strip = 0; strip < strips; ++strip) {
      strip_bias_[strip] = static_cast<float>(level.bias[block_row * level.block_columns + level.block_of_strip[strip]]);
    }
    const int per_strip = level.cells_per_strip;
    cells_.resize(static_cast<std::size_t>(cell_rows) * strips * per_strip);
    for (int k = 0; k < cell_rows; ++k) {
      const int row = begin + k * level.cell_rows;
      sumCells(input, row, std::min(level.cell_rows, end - row), per_strip, strip_bias_.data(),
               cells_.data() + k * strips * per_strip);
    }
    const int cell_columns = image::Patch::kStrip / per_strip;
    for (int strip = 0; strip < strips; ++strip) {
      for (int cell = strip * per_strip; cell < (strip + 1) * per_strip; ++cell) {
        const int columns = std::min(cell_columns, level.value.width() - cell * cell_columns);
        if (columns <= 0) break;
        const double u = unit_T_patch(0, 2) + unit_T_patch(0, 0) * (cell * cell_columns + 0.5 * (columns - 1));
        for (int k = 0; k < cell_rows; ++k) {
          const int row = begin + k * level.cell_rows;
          const int rows = std::min(level.cell_rows, end - row);
          const double v = unit_T_patch(1, 2) + unit_T_patch(1, 1) * (row + 0.5 * (rows - 1));
          equations_.addCell(cells_[k * strips * per_strip + cell], u, v);
        }
      }
      if (strip + 1 < strips && level.block_of_strip[strip + 1] == level.block_of_strip[strip]) continue;
      equations_.endBlock();
      block_sums_.push_back({equations_.blockWeight(), equations_.blockResidual(), equations_.blockJacobian()});
    }
  }
}

bool Esm::solve(EsmLevel& level, EsmState& state, double& step) {
  const Matrix10d a = equations_.matrix();
  // Unit diagonal first: grey levels and normalised coordinates have nothing to do with each other.
  const Vector10d d = a.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Matrix10d> factors(d.asDiagonal() * a * d.asDiagonal());
  if (factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > 1e-9)) return false;
  const Vector10d x = -(d.asDiagonal() * factors.solve(d.asDiagonal() * equations_.vector()));
  if (!x.allFinite()) return false;
  const Eigen::Matrix3d motion = geometry::sl3Exp(x.head<8>());
  const geometry::Quadrilateral before = geometry::apply(state.g, roi_.corners());
  state.g = state.g * n_inv_ * motion * n_;
  state.g /= std::cbrt(state.g.determinant());
  state.gain += x[8];
  state.bias += x[9];
  double bias = 0.0;
  double weight = 0.0;
  for (std::size_t k = 0; k < block_sums_.size(); ++k) {
    const BlockSums& sums = block_sums_[k];
    if (config_.light == Light::kLocal && sums.weight > 0.0) {
      level.bias[k] -= (sums.residual + sums.jacobian.dot(x)) / sums.weight;
      bias += sums.weight * level.bias[k];
      weight += sums.weight;
    } else if (config_.light != Light::kLocal) {
      level.bias[k] = state.bias;
    }
  }
  if (weight > 0.0) state.bias = bias / weight;
  const geometry::Quadrilateral after = geometry::apply(state.g, roi_.corners());
  step = 0.0;
  for (int k = 0; k < 4; ++k) step = std::max(step, (after[k] - before[k]).norm());
  return state.g.allFinite() && std::isfinite(step) && state.gain > 0.0;
}

double Esm::predictedCornerError(double sigma) const {
  const Matrix10d a = equations_.matrix();
  const Vector10d d = a.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Matrix10d> factors(d.asDiagonal() * a * d.asDiagonal());
  if (factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > 1e-12)) {
    return std::numeric_limits<double>::infinity();
  }
  const Matrix10d inverse = d.asDiagonal() * factors.solve(Matrix10d(d.asDiagonal()));
  double worst = 0.0;
  for (const Eigen::Vector2d& corner : roi_.corners()) {
    const Eigen::Vector2d p = geometry::apply(n_, corner);
    const Eigen::Matrix<double, 2, 8> j = half_size_ * cornerJacobian(p.x(), p.y());
    worst = std::max(worst, (j * inverse.topLeftCorner<8, 8>() * j.transpose()).trace());
  }
  return sigma * std::sqrt(worst);
}

double Esm::referenceCornerError(double sigma) {
  EsmLevel& level = levels_[0];
  copy(level.value.view(), level.warped);
  level.warped.extrapolate();
  level.all_valid = true;
  accumulate(level, EsmState(), sigma);
  return predictedCornerError(std::sqrt(2.0) * sigma);
}

EsmResult Esm::align(const image::RegionPyramid& current, const EsmState& start, int finest, int coarsest) {
  EsmResult result;
  result.state = start;
  result.corner_error = std::numeric_limits<double>::infinity();
  for (int l = std::min({coarsest, levels() - 1, current.levels() - 1}); l >= finest; --l) {
    EsmLevel& level = levels_[l];
    const double min_step = l == finest ? config_.min_step : std::max(config_.min_step, 0.1 * level.scale);
    result.status = EsmStatus::kMaxIterations;
    for (int k = 0; k < config_.max_iterations; ++k) {
      if (!geometry::isConvex(geometry::apply(result.state.g, roi_.corners()))) {
        result.status = EsmStatus::kOutOfView;
        return result;
      }
      warp(current, level, l, result.state.g);
      if (k == 0 && !(light_known_ && config_.light == Light::kLocal)) startLight(level, result.state);
      result.sigma = residualScale(level, result.state);
      accumulate(level, result.state, result.sigma);
      ++result.iterations;
      if (!solve(level, result.state, result.last_step)) {
        result.status = EsmStatus::kIllConditioned;
        return result;
      }
      if (result.last_step < min_step) {
        result.status = EsmStatus::kConverged;
        break;
      }
    }
  }
  light_known_ = true;
  result.corner_error = predictedCornerError(result.sigma);
  return result;
}

}  // namespace laparoscope_servo::tracking
