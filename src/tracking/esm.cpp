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

}  // namespace

void Esm::setReference(const image::RegionPyramid& reference, const geometry::Rectangle& roi) {
  roi_ = roi;
  half_size_ = std::max(roi.width, roi.height) / 2.0;
  n_ = scaling(1.0 / half_size_, -roi.centre().x() / half_size_, -roi.centre().y() / half_size_);
  n_inv_ = n_.inverse();
  levels_.clear();
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

double Esm::residualScale(const EsmLevel& level, const EsmState& state) {
  samples_.clear();
  const std::size_t pixels = level.value.total();
  const int stride = static_cast<int>(std::max<std::size_t>(1, pixels / kMaxSamples));
  const float gain = static_cast<float>(state.gain);
  const float bias = static_cast<float>(state.bias);
  // A stride along the rows that starts elsewhere in each row, so that no pattern of the image is preferred.
  for (int j = 0; j < level.value.rows; ++j) {
    for (int i = (j * 7) % stride; i < level.value.cols; i += stride) {
      if (level.weight(j, i) * valid_(j, i) > 0.0f) {
        samples_.push_back(std::abs(gain * warped_(j, i) + bias - level.value(j, i)));
      }
    }
  }
  if (samples_.empty()) return kMinSigma;
  const auto middle = samples_.begin() + static_cast<std::ptrdiff_t>(samples_.size() / 2);
  std::nth_element(samples_.begin(), middle, samples_.end());
  return std::max(kMinSigma, kMadToSigma * static_cast<double>(*middle));
}

void Esm::accumulate(const EsmLevel& level, const EsmState& state, double sigma) {
  const int width = level.value.cols;
  for (std::vector<float>* row : {&row_gx_, &row_gy_, &row_residual_, &row_intensity_, &row_weight_}) row->resize(width);
  const float gain = static_cast<float>(state.gain);
  const float bias = static_cast<float>(state.bias);
  const float half_per_unit = static_cast<float>(0.5 * half_size_ / level.scale);
  const float rejection = config_.robust ? static_cast<float>(1.0 / (kTukey * sigma)) : 0.0f;
  const Eigen::Matrix3d unit_T_patch = n_ * level.image_T_patch;
  PixelRow row;
  row.count = width;
  row.u0 = static_cast<float>(unit_T_patch(0, 2));
  row.du = static_cast<float>(unit_T_patch(0, 0));
  row.gx = row_gx_.data();
  row.gy = row_gy_.data();
  row.residual = row_residual_.data();
  row.intensity = row_intensity_.data();
  row.weight = row_weight_.data();
  equations_.reset();
  for (int j = 0; j < level.value.rows; ++j) {
    const float* t = level.value.ptr<float>(j);
    const float* i = warped_.ptr<float>(j);
    const float* tx = level.gx.ptr<float>(j);
    const float* ty = level.gy.ptr<float>(j);
    const float* ix = gx_.ptr<float>(j);
    const float* iy = gy_.ptr<float>(j);
    const float* w = level.weight.ptr<float>(j);
    const float* valid = valid_.ptr<float>(j);
#pragma omp simd
    for (int k = 0; k < width; ++k) {
      const float r = gain * i[k] + bias - t[k];
      const float e = r * rejection;
      const float tukey = std::max(0.0f, 1.0f - e * e);
      row_residual_[k] = r;
      row_intensity_[k] = 0.5f * (i[k] + t[k]);
      row_gx_[k] = half_per_unit * (gain * ix[k] + tx[k]);  // the mean of both gradients makes the step second-order
      row_gy_[k] = half_per_unit * (gain * iy[k] + ty[k]);
      row_weight_[k] = w[k] * valid[k] * tukey * tukey;
    }
    row.v = unit_T_patch(1, 1) * j + unit_T_patch(1, 2);
    equations_.add(row, config_.illumination);
  }
}

bool Esm::solve(EsmState& state, double& step) {
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
  accumulate(level, EsmState(), sigma);
  return predictedCornerError(std::sqrt(2.0) * sigma);
}

EsmResult Esm::align(const image::RegionPyramid& current, const EsmState& start, int finest, int coarsest) {
  EsmResult result;
  result.state = start;
  result.corner_error = std::numeric_limits<double>::infinity();
  for (int l = std::min({coarsest, levels() - 1, current.levels() - 1}); l >= finest; --l) {
    const EsmLevel& level = levels_[l];
    const double min_step = l == finest ? config_.min_step : std::max(config_.min_step, 0.1 * level.scale);
    result.status = EsmStatus::kMaxIterations;
    for (int k = 0; k < config_.max_iterations; ++k) {
      if (!geometry::isConvex(geometry::apply(result.state.g, roi_.corners()))) {
        result.status = EsmStatus::kOutOfView;
        return result;
      }
      warp(current, level, l, result.state.g);
      result.sigma = residualScale(level, result.state);
      accumulate(level, result.state, result.sigma);
      ++result.iterations;
      if (!solve(result.state, result.last_step)) {
        result.status = EsmStatus::kIllConditioned;
        return result;
      }
      if (result.last_step < min_step) {
        result.status = EsmStatus::kConverged;
        break;
      }
    }
  }
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
