#include "laparoscope_servo/tracking/esm.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "laparoscope_servo/geometry/sl3.h"
#include "laparoscope_servo/image/warp.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kMinLevelSide = 8;        // px
constexpr double kTukey = 4.6851;       // 95 % efficiency for normal noise (Marchand and Chaumette 2004, appendix)
constexpr double kMadToSigma = 1.4826;  // normal noise
constexpr double kMinSigma = 1.0;       // grey levels; below it quantisation is mistaken for outliers
constexpr std::size_t kMaxSamples = 4096;

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

// Blocks of light are as wide as a twelfth of the ROI, to follow its shading, and at least this wide, to leave the texture's own
// contrast to the motion.
constexpr int kLightBlock = 16;  // px of the level
constexpr int kLightBlocksAlong = 12;

int blocksAlong(int pixels) { return std::clamp((pixels + kLightBlock / 2) / kLightBlock, 1, kLightBlocksAlong); }

}  // namespace

void Esm::setReference(const image::RegionPyramid& reference, const geometry::Rectangle& roi) {
  roi_ = roi;
  half_size_ = std::max(roi.width, roi.height) / 2.0;
  n_ = scaling(1.0 / half_size_, -roi.centre().x() / half_size_, -roi.centre().y() / half_size_);
  n_inv_ = n_.inverse();
  levels_.clear();
  forgetLight();
  const int x = static_cast<int>(roi.x) - reference.origin().x;
  const int y = static_cast<int>(roi.y) - reference.origin().y;
  const int right = x + static_cast<int>(roi.width) - 1;
  const int bottom = y + static_cast<int>(roi.height) - 1;
  for (int l = 0; l < std::min(config_.levels, reference.levels()); ++l) {
    const int size = 1 << l;
    const cv::Point begin((x + size - 1) / size, (y + size - 1) / size);
    const cv::Point end(right / size, bottom / size);
    const cv::Rect patch(begin, cv::Size(end.x - begin.x + 1, end.y - begin.y + 1));
    if (l > 0 && std::min(patch.width, patch.height) < kMinLevelSide) break;
    EsmLevel level;
    level.value = reference.level(l)(patch).clone();
    image::gradients(level.value, level.gx, level.gy);
    level.weight = cv::Mat1f::ones(patch.size());
    level.blocks = image::AreaGrid(patch.width, patch.height, blocksAlong(patch.height), blocksAlong(patch.width));
    level.bias.assign(level.blocks.count(), 0.0);
    level.scale = size;
    level.first = begin * size - cv::Point(x, y);
    level.image_T_patch = scaling(size, roi.x + level.first.x, roi.y + level.first.y);
    levels_.push_back(level);
  }
}

void Esm::setWeights(const cv::Mat1f& weights) {
  weights.copyTo(levels_[0].weight);
  for (std::size_t l = 1; l < levels_.size(); ++l) {
    const EsmLevel& fine = levels_[l - 1];
    EsmLevel& coarse = levels_[l];
    const int fine_scale = static_cast<int>(fine.scale);
    const cv::Point offset = (coarse.first - fine.first) / fine_scale;
    for (int j = 0; j < coarse.weight.rows; ++j) {
      const int below = std::min(2 * j + offset.y + 1, fine.weight.rows - 1);
      for (int i = 0; i < coarse.weight.cols; ++i) {
        const int next = std::min(2 * i + offset.x + 1, fine.weight.cols - 1);
        float least = 1.0f;
        for (int b = std::max(2 * j + offset.y - 1, 0); b <= below; ++b) {
          for (int a = std::max(2 * i + offset.x - 1, 0); a <= next; ++a) least = std::min(least, fine.weight(b, a));
        }
        coarse.weight(j, i) = least;
      }
    }
  }
}

void Esm::warp(const image::RegionPyramid& current, const EsmLevel& level, int l, const Eigen::Matrix3d& g) {
  const double size = level.scale;
  const Eigen::Matrix3d level_T_image = scaling(1.0 / size, -current.origin().x / size, -current.origin().y / size);
  warped_.create(level.value.size());
  valid_.create(level.value.size());
  // A pixel beside one that is not valid has no gradient.
  if (!image::warpBilinear(current.level(l), level_T_image * g * level.image_T_patch, warped_, valid_)) {
    cv::Mat1f eroded = valid_.clone();
    for (int j = 0; j < valid_.rows; ++j) {
      for (int i = 0; i < valid_.cols; ++i) {
        float least = valid_(j, i);
        if (i > 0) least = std::min(least, valid_(j, i - 1));
        if (j > 0) least = std::min(least, valid_(j - 1, i));
        if (i + 1 < valid_.cols) least = std::min(least, valid_(j, i + 1));
        if (j + 1 < valid_.rows) least = std::min(least, valid_(j + 1, i));
        eroded(j, i) = least;
      }
    }
    valid_ = eroded;
  }
  image::gradients(warped_, gx_, gy_);
}

void Esm::forgetLight() { light_known_ = false; }

void Esm::startLight(EsmLevel& level, const EsmState& state) {
  for (int row = 0; row < level.blocks.rows(); ++row) {
    for (int column = 0; column < level.blocks.columns(); ++column) {
      double sum = 0.0;
      double weight = 0.0;
      for (int j = level.blocks.rowBegin(row); j < level.blocks.rowBegin(row + 1); ++j) {
        for (int i = level.blocks.columnBegin(column); i < level.blocks.columnBegin(column + 1); ++i) {
          const double w = level.weight(j, i) * valid_(j, i);
          sum += w * (level.value(j, i) - state.gain * warped_(j, i));
          weight += w;
        }
      }
      level.bias[row * level.blocks.columns() + column] = weight > 0.0 ? sum / weight : state.bias;
    }
  }
}

void Esm::computeResidual(const EsmLevel& level, const EsmState& state) {
  residual_.create(level.value.size());
  const float gain = static_cast<float>(state.gain);
  for (int j = 0; j < level.value.rows; ++j) {
    const float* t = level.value.ptr<float>(j);
    const float* image = warped_.ptr<float>(j);
    float* r = residual_.ptr<float>(j);
    const double* bias = level.bias.data() + level.blocks.rowOf(j) * level.blocks.columns();
    for (int column = 0; column < level.blocks.columns(); ++column) {
      const float b = static_cast<float>(bias[column]);
      const int end = level.blocks.columnBegin(column + 1);
      for (int k = level.blocks.columnBegin(column); k < end; ++k) r[k] = gain * image[k] + b - t[k];
    }
  }
}

double Esm::residualScale(const EsmLevel& level) {
  samples_.clear();
  const int stride = static_cast<int>(std::max<std::size_t>(1, level.value.total() / kMaxSamples));
  // A stride along the rows that starts elsewhere in each row, so that no pattern of the image is preferred.
  for (int j = 0; j < level.value.rows; ++j) {
    for (int i = (j * 7) % stride; i < level.value.cols; i += stride) {
      if (level.weight(j, i) * valid_(j, i) > 0.0f) samples_.push_back(std::abs(residual_(j, i)));
    }
  }
  if (samples_.empty()) return kMinSigma;
  const auto middle = samples_.begin() + static_cast<std::ptrdiff_t>(samples_.size() / 2);
  std::nth_element(samples_.begin(), middle, samples_.end());
  return std::max(kMinSigma, kMadToSigma * static_cast<double>(*middle));
}

void Esm::accumulate(const EsmLevel& level, const EsmState& state, double sigma) {
  const float gain = static_cast<float>(state.gain);
  const float half_per_unit = static_cast<float>(0.5 * half_size_ / level.scale);
  const float rejection = config_.robust ? static_cast<float>(1.0 / (kTukey * sigma)) : 0.0f;
  const Eigen::Matrix3d unit_T_patch = n_ * level.image_T_patch;
  for (std::vector<float>* row : {&row_gx_, &row_gy_, &row_intensity_, &row_weight_}) row->resize(level.value.cols);
  PixelRow row;
  row.du = static_cast<float>(unit_T_patch(0, 0));
  row.gx = row_gx_.data();
  row.gy = row_gy_.data();
  row.intensity = row_intensity_.data();
  row.weight = row_weight_.data();
  equations_.reset(config_.light);
  block_sums_.clear();
  for (int block_row = 0; block_row < level.blocks.rows(); ++block_row) {
    for (int column = 0; column < level.blocks.columns(); ++column) {
      const int begin = level.blocks.columnBegin(column);
      row.count = level.blocks.columnBegin(column + 1) - begin;
      row.u0 = static_cast<float>(unit_T_patch(0, 2) + unit_T_patch(0, 0) * begin);
      for (int j = level.blocks.rowBegin(block_row); j < level.blocks.rowBegin(block_row + 1); ++j) {
        const float* t = level.value.ptr<float>(j) + begin;
        const float* image = warped_.ptr<float>(j) + begin;
        const float* tx = level.gx.ptr<float>(j) + begin;
        const float* ty = level.gy.ptr<float>(j) + begin;
        const float* ix = gx_.ptr<float>(j) + begin;
        const float* iy = gy_.ptr<float>(j) + begin;
        const float* w = level.weight.ptr<float>(j) + begin;
        const float* valid = valid_.ptr<float>(j) + begin;
        const float* r = residual_.ptr<float>(j) + begin;
#pragma omp simd
        for (int k = 0; k < row.count; ++k) {
          const float e = r[k] * rejection;
          const float tukey = std::max(0.0f, 1.0f - e * e);
          row_intensity_[k] = 0.5f * (image[k] + t[k]);
          row_gx_[k] = half_per_unit * (gain * ix[k] + tx[k]);  // the mean of both gradients makes the step second-order
          row_gy_[k] = half_per_unit * (gain * iy[k] + ty[k]);
          row_weight_[k] = w[k] * valid[k] * tukey * tukey;
        }
        row.residual = r;
        row.v = unit_T_patch(1, 1) * j + unit_T_patch(1, 2);
        equations_.add(row);
      }
      equations_.endBlock();
      block_sums_.push_back({equations_.blockWeight(), equations_.blockResidual(), equations_.blockJacobian()});
    }
  }
}

bool Esm::solve(EsmLevel& level, EsmState& state, double& step) {
  const Matrix10d& a = equations_.matrix();
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
    } else {
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
  const EsmLevel& level = levels_[0];
  level.value.copyTo(warped_);
  level.gx.copyTo(gx_);
  level.gy.copyTo(gy_);
  valid_ = cv::Mat1f::ones(level.value.size());
  computeResidual(level, EsmState());
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
      computeResidual(level, result.state);
      result.sigma = residualScale(level);
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

double zncc(const cv::Mat1f& a, const cv::Mat1f& b, const cv::Mat1f& weight) {
  double sw = 0.0, sa = 0.0, sb = 0.0, saa = 0.0, sbb = 0.0, sab = 0.0;
  for (int j = 0; j < a.rows; ++j) {
    const float* pa = a.ptr<float>(j);
    const float* pb = b.ptr<float>(j);
    const float* pw = weight.ptr<float>(j);
    float w = 0, wa = 0, wb = 0, waa = 0, wbb = 0, wab = 0;
#pragma omp simd reduction(+ : w, wa, wb, waa, wbb, wab)
    for (int i = 0; i < a.cols; ++i) {
      w += pw[i];
      wa += pw[i] * pa[i];
      wb += pw[i] * pb[i];
      waa += pw[i] * pa[i] * pa[i];
      wbb += pw[i] * pb[i] * pb[i];
      wab += pw[i] * pa[i] * pb[i];
    }
    sw += w;
    sa += wa;
    sb += wb;
    saa += waa;
    sbb += wbb;
    sab += wab;
  }
  const double va = saa * sw - sa * sa;
  const double vb = sbb * sw - sb * sb;
  // Rounding in float leaves about 1e-6 of the square of the mean.
  if (!(va > 1e-5 * saa * sw) || !(vb > 1e-5 * sbb * sw)) return 0.0;
  return std::clamp((sab * sw - sa * sb) / std::sqrt(va * vb), -1.0, 1.0);
}

}  // namespace laparoscope_servo::tracking
