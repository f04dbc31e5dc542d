#include "features/points/affine_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "features/points/agreement.h"
#include "laparoscope_servo/image/multiversion.h"
#include "laparoscope_servo/robust/mad.h"
#include "laparoscope_servo/robust/weights.h"

namespace laparoscope_servo::features {

namespace {

constexpr int kMaxIterations = 10;
constexpr int kWeighings = 3;    // iterations that measure the scale anew; it hardly changes afterwards
constexpr double kStep = 0.01;   // px of the window: smaller steps end the iteration
constexpr double kFar = 0.1;     // px of the window: larger last steps have not converged
constexpr double kDeform = 1.0;  // px at the window's border, standard deviation of a change of shape in an image
constexpr double kNoise = 0.5;   // grey levels: less noise than that is not believed, for pixels are whole numbers
constexpr double kMaxDeformation = 0.4;  // of a window, other than was expected: what is not alike is bent at will
constexpr double kLeastContrast = 4.0 * kNoise;  // grey levels: less is the noise of a flat window, not texture
constexpr double kMaxGain = 3.0;                 // of the light, and its inverse

LAPAROSCOPE_SERVO_CLONES
float dotProduct(const float* __restrict a, const float* __restrict b, int count) {
  float total = 0.0f;
#pragma omp simd reduction(+ : total)
  for (int k = 0; k < count; ++k) total += a[k] * b[k];
  return total;
}

// The level that a scale of `scale` (px of the image per px of the view) is best compared on.
int levelFor(double scale, int levels) {
  return std::clamp(static_cast<int>(std::lround(std::log2(scale))), 0, levels - 1);
}

}  // namespace

double PointPose::scale() const {
  return std::sqrt(shape.determinant());
}

bool PointView::take(const PointImage& picture, const Eigen::Vector2d& place, int half) {
  place_ = place;
  bool whole = false;
  for (int l = 0; l < kLevels; ++l) {
    Window& window = windows_[static_cast<std::size_t>(l)];
    window = Window(half);
    const double size = 1 << l;
    const double share =
        window.sample(picture, std::min(l, picture.levels() - 1), place, size * Eigen::Matrix2d::Identity());
    if (l == 0) whole = share >= 1.0;
  }
  return whole;
}

AffineFitter::AffineFitter(const PointsConfig& config) : config_(config), now_(config.window / 2) {
  const auto count = static_cast<std::size_t>(now_.count());
  for (std::vector<float>& column : jacobian_) column.assign(count, 0.0f);
  for (std::vector<float>* values : {&residuals_, &weights_, &weighted_}) values->assign(count, 0.0f);
  scratch_.reserve(count);
  for (int l = 0; l < config.levels; ++l) {
    const double size = 1 << l, smoothing = size * image::levelNoise(1 << l).deviation;
    unsmoothed_.push_back(1.0 / (smoothing * smoothing));
  }
}

const AffineFit& AffineFitter::fit(const PointView& view, const PointImage& image, const PointPose& start) {
  fit_ = AffineFit();
  fit_.pose = start;
  const double scale = start.scale();
  if (!(scale > 0.0) || !std::isfinite(scale) || !start.place.allFinite()) {
    fit_.reason = Reason::kShape;
    return fit_;
  }
  // What appears smaller than it was is compared on a coarser level of the view, else on one of the image.
  const int view_level = levelFor(1.0 / scale, PointView::kLevels), image_level = levelFor(scale, image.levels());
  const Window& window = view.window(view_level);
  if (iterate(window, image, view_level, image_level, start)) judge(window, image, view_level, image_level, start);
  return fit_;
}

// r = a I + b - T for each pixel, and its derivatives by translation, deformation, gain and offset: the mean of those
// of both images, which makes the step exact to the second order.
void AffineFitter::compare(const Window& view) {
  const int side = view.side(), half = view.half(), stride = view.stride();
  const auto gain = static_cast<float>(fit_.pose.gain), offset = static_cast<float>(fit_.pose.offset);
  const auto middle = static_cast<float>(view.mean());
  const float unit = 1.0f / static_cast<float>(half);
  for (int j = 0; j < side; ++j) {
    const float v = static_cast<float>(j - half) * unit;
    for (int i = 0; i < side; ++i) {
      const auto k = static_cast<std::size_t>(j * stride + i);
      const float u = static_cast<float>(i - half) * unit;
      const float gx = 0.5f * (gain * now_.gradientX()[k] + view.gradientX()[k]),
                  gy = 0.5f * (gain * now_.gradientY()[k] + view.gradientY()[k]);
      residuals_[k] = gain * now_.values()[k] + offset - view.values()[k];  // eq. (1), with the light
      jacobian_[0][k] = gx;
      jacobian_[1][k] = gy;
      jacobian_[2][k] = gx * u;
      jacobian_[3][k] = gx * v;
      jacobian_[4][k] = gy * u;
      jacobian_[5][k] = gy * v;
      jacobian_[6][k] = now_.values()[k] - middle;
      jacobian_[7][k] = 1.0f;
      weights_[k] = view.valid()[k] * now_.valid()[k];
    }
  }
}

void AffineFitter::weigh() {
  const float scale = sigma_ > 0.0 ? 1.0f / static_cast<float>(robust::kTukey * sigma_) : 0.0f;
  for (std::size_t k = 0; k < residuals_.size(); ++k) {
    const float t = residuals_[k] * scale, left = std::max(0.0f, 1.0f - t * t);
    weights_[k] *= left * left;  // eq. (12)
  }
}

void AffineFitter::sum() {
  const int count = now_.count();
  for (int r = 0; r < kUnknowns; ++r) {
    const std::vector<float>& row = jacobian_[static_cast<std::size_t>(r)];
    for (std::size_t k = 0; k < row.size(); ++k) weighted_[k] = weights_[k] * row[k];
    for (int c = 0; c <= r; ++c) {
      normal_(r, c) = normal_(c, r) =
          dotProduct(weighted_.data(), jacobian_[static_cast<std::size_t>(c)].data(), count);
    }
    right_[r] = -dotProduct(weighted_.data(), residuals_.data(), count);
  }
}

bool AffineFitter::iterate(const Window& view, const PointImage& image, int view_level, int image_level,
                           const PointPose& start) {
  const double size = 1 << view_level;
  PointPose& pose = fit_.pose;
  const double half = view.half();
  double step = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    if (!image.holds(pose.place)) {
      fit_.reason = Reason::kOutside;
      return false;
    }
    now_.sample(image, image_level, pose.place, size * pose.shape);
    compare(view);
    if (iteration < kWeighings) {
      scratch_.clear();  // every other pixel tells the scale
      for (std::size_t k = 0; k < residuals_.size(); k += 2) {
        if (weights_[k] > 0.0f) scratch_.push_back(residuals_[k]);
      }
      if (static_cast<double>(2 * scratch_.size()) < config_.min_share * view.side() * view.side()) {
        fit_.reason = Reason::kCovered;
        return false;
      }
      sigma_ = std::max(kNoise, robust::spread(scratch_).sigma);  // eq. (13)
    }
    weigh();
    sum();
    if (!(step > kStep)) return true;
    // What is known of the shape: that it changes little from image to image.
    Normal information = normal_;
    Vector right = right_;
    const double certainty = sigma_ * sigma_ / (kDeform * kDeform);
    const Eigen::Matrix2d change = half * (start.shape.inverse() * pose.shape - Eigen::Matrix2d::Identity());
    const Eigen::Vector4d changes(change(0, 0), change(0, 1), change(1, 0), change(1, 1));
    for (int k = 0; k < 4; ++k) {
      information(2 + k, 2 + k) += certainty;
      right[2 + k] -= certainty * changes[k];
    }
    const Eigen::LDLT<Normal> solver(information);
    const Vector x = solver.solve(right);
    if (!x.allFinite() || !(x.head<2>().norm() < half)) return false;
    Eigen::Matrix2d deformation;
    deformation << x[2], x[3], x[4], x[5];
    // Composed on the view's side, where the derivatives are.
    pose.place += size * pose.shape * x.head<2>();
    pose.shape = pose.shape * (Eigen::Matrix2d::Identity() + deformation / half);
    pose.gain += x[6];
    pose.offset += x[7] - x[6] * view.mean();
    if (!(pose.shape.determinant() > 0.0) || !(pose.gain > 1.0 / kMaxGain && pose.gain < kMaxGain)) return false;
    step = std::max(x.head<2>().norm(), deformation.norm());
  }
  return step < kFar;
}

void AffineFitter::judge(const Window& view, const PointImage& image, int view_level, int image_level,
                         const PointPose& start) {
  double total = 0.0;
  double a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::size_t k = 0; k < weights_.size(); ++k) {
    const double w = weights_[k];
    if (!(w > 0.0)) continue;
    const double p = view.values()[k] - view.mean(), q = now_.values()[k] - view.mean();
    total += w;
    a += w * p;
    b += w * q;
    aa += w * p * p;
    bb += w * q * q;
    ab += w * p * q;
  }
  const double spread = (aa - a * a / total) * (bb - b * b / total);
  fit_.correlation = spread > 0.0 ? (ab - a * b / total) / std::sqrt(spread) : 0.0;
  fit_.share = agreeingShare(view, now_, residuals_);

  // The pixels were smoothed, so that neighbours err together: as sums over several of them the residuals are as large
  // as those of the image before it was smoothed.
  const double variance = sigma_ * sigma_ * unsmoothed_[static_cast<std::size_t>(image_level)];
  const Normal inverse = Eigen::LDLT<Normal>(normal_).solve(Normal::Identity());
  const Eigen::Matrix2d to_image = (1 << view_level) * fit_.pose.shape;
  fit_.covariance = variance * to_image * inverse.topLeftCorner<2, 2>() * to_image.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(fit_.covariance, Eigen::EigenvaluesOnly);
  fit_.expected_error = std::sqrt(solver.eigenvalues()[1]);

  const Eigen::Matrix2d stretch = fit_.pose.shape.transpose() * fit_.pose.shape;
  solver.computeDirect(stretch, Eigen::EigenvaluesOnly);
  const double longest = std::sqrt(solver.eigenvalues()[1]), shortest = std::sqrt(solver.eigenvalues()[0]);
  const Eigen::Matrix2d deformation = start.shape.inverse() * fit_.pose.shape - Eigen::Matrix2d::Identity();
  if (!image.holds(fit_.pose.place)) {
    fit_.reason = Reason::kOutside;
  } else if (!(fit_.share >= config_.min_share)) {
    fit_.reason = Reason::kCovered;
  } else if (!(fit_.correlation >= config_.min_correlation)) {
    fit_.reason = Reason::kNotSeen;
  } else if (!(longest <= config_.max_distortion * shortest) || !(longest <= config_.max_scale) ||
             !(shortest >= 1.0 / config_.max_scale) || !(deformation.norm() <= kMaxDeformation)) {
    fit_.reason = Reason::kShape;
  } else if (!(fit_.expected_error <= config_.max_error) || !(view.contrast() >= kLeastContrast)) {
    fit_.reason = Reason::kUncertain;
  } else {
    fit_.reason = Reason::kNone;
  }
}

}  // namespace laparoscope_servo::features
