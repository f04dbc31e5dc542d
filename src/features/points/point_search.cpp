#include "features/points/point_search.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace laparoscope_servo::features {

namespace {

constexpr double kLeastShare = 0.5;  // of the view's pixels that have to be seen
constexpr int kLevel = 1;            // of the view: its correlation is wide enough to be found in steps of a pixel

}  // namespace

PointSearch::PointSearch(double range, int half) : range_(range) {
  const auto most = static_cast<std::size_t>(2 * half + 1) * static_cast<std::size_t>(2 * half + 1);
  values_.reserve(most);
  at_.reserve(most);
}

bool PointSearch::find(const PointView& view, const PointImage& image, PointPose& pose) {
  const Window& window = view.window(kLevel);
  const double scale = pose.scale();
  if (!(scale > 0.0) || !std::isfinite(scale) || !image.holds(pose.place)) return false;
  const double coarse = std::log2(scale * (1 << kLevel));
  const int l = std::clamp(static_cast<int>(std::lround(coarse)), 0, image.levels() - 1);
  const cv::Mat1f& level = image.level(l);
  const double size = 1 << l;
  const auto stride = static_cast<std::ptrdiff_t>(level.step1());

  // The view as this level would show it around a pixel. The finest window's extent, of a window twice as large.
  values_.clear();
  at_.clear();
  const Eigen::Matrix2d back = pose.shape.inverse() * (size / (1 << kLevel));
  const int most = 2 * window.half();
  const double extent = 0.5 * window.half();
  int reach = 0;
  for (int j = -most; j <= most; ++j) {
    for (int i = -most; i <= most; ++i) {
      const Eigen::Vector2d p = back * Eigen::Vector2d(i, j);
      float value = 0.0f;
      if (!(p.cwiseAbs().maxCoeff() <= extent) || !window.at(p.x(), p.y(), value)) continue;
      values_.push_back(value);
      at_.push_back(j * stride + i);
      reach = std::max({reach, std::abs(i), std::abs(j)});
    }
  }
  const double expected = 4.0 * extent * extent / std::abs(back.determinant());
  if (!(static_cast<double>(values_.size()) > kLeastShare * expected)) return false;
  float mean = 0.0f, squares = 0.0f;
  for (const float value : values_) mean += value / static_cast<float>(values_.size());
  for (float& value : values_) {
    value -= mean;
    squares += value * value;
  }

  const int x = static_cast<int>(std::lround(pose.place.x() / size)),
            y = static_cast<int>(std::lround(pose.place.y() / size)),
            range = std::max(1, static_cast<int>(std::ceil(range_ / size)));
  const int left = std::max(x - range, reach), right = std::min(x + range, level.cols - 1 - reach),
            top = std::max(y - range, reach), low = std::min(y + range, level.rows - 1 - reach);
  double best = -1.0;
  Eigen::Vector2d place = pose.place;
  for (int v = top; v <= low; ++v) {
    for (int u = left; u <= right; ++u) {
      const float* centre = level.ptr<float>(v) + u;
      float product = 0.0f, sum = 0.0f, square = 0.0f;
      for (std::size_t k = 0; k < at_.size(); ++k) {
        const float value = centre[at_[k]];
        product += values_[k] * value;
        sum += value;
        square += value * value;
      }
      const double variance = square - sum * (sum / static_cast<double>(at_.size()));
      const double correlation = variance > 0.0 ? product / std::sqrt(variance * squares) : -1.0;
      if (!(correlation > best)) continue;
      best = correlation;
      place = size * Eigen::Vector2d(u, v);
      // What the light does to it there, for the fit to start from.
      pose.gain = std::sqrt(squares / variance);
      pose.offset = mean - pose.gain * sum / static_cast<double>(at_.size());
    }
  }
  pose.place = place;
  return best > 0.0;
}

}  // namespace laparoscope_servo::features
