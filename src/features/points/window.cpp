#include "features/points/window.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace laparoscope_servo::features {

namespace {

constexpr int kVector = 16;  // floats of the widest vector

float bilinear(const cv::Mat1f& level, float x, float y) {
  const int u = std::min(static_cast<int>(x), level.cols - 2), v = std::min(static_cast<int>(y), level.rows - 2);
  const float fx = x - static_cast<float>(u), fy = y - static_cast<float>(v);
  const float* above = level.ptr<float>(v) + u;
  const float* below = level.ptr<float>(v + 1) + u;
  const float top = above[0] + fx * (above[1] - above[0]), bottom = below[0] + fx * (below[1] - below[0]);
  return top + fy * (bottom - top);
}

// Within 0 and `most`; 0 for NaN, which could not be cast.
float within(float value, float most) {
  return value > 0.0f ? std::min(value, most) : 0.0f;
}

}  // namespace

Window::Window(int half) : half_(half), stride_((2 * half + kVector) / kVector * kVector) {
  const auto samples = static_cast<std::size_t>(2 * half + 3);
  margin_.assign(samples * samples, 0.0f);
  for (std::vector<float>* values : {&values_, &gx_, &gy_, &valid_}) {
    values->assign(static_cast<std::size_t>(count()), 0.0f);
  }
}

double Window::sample(const PointImage& image, int l, const Eigen::Vector2d& centre, const Eigen::Matrix2d& a) {
  const double scale = 1.0 / (1 << l);
  fill(image.level(l), scale * centre, scale * a);
  for (int j = 0; j < side(); ++j) {
    float* valid = valid_.data() + static_cast<std::ptrdiff_t>(j) * stride_;
    for (int i = 0; i < side(); ++i) {
      const double x = centre.x() + a(0, 0) * (i - half_) + a(0, 1) * (j - half_),
                   y = centre.y() + a(1, 0) * (i - half_) + a(1, 1) * (j - half_);
      valid[i] = image.isUsable(x, y) ? 1.0f : 0.0f;
    }
  }
  differentiate();
  return summarise();
}

void Window::fill(const cv::Mat1f& level, const Eigen::Vector2d& centre, const Eigen::Matrix2d& a) {
  const int samples = 2 * half_ + 3;
  const auto ax = static_cast<float>(a(0, 0)), ay = static_cast<float>(a(1, 0));
  const auto right = static_cast<float>(level.cols - 1), low = static_cast<float>(level.rows - 1);
  for (int j = 0; j < samples; ++j) {
    float* row = margin_.data() + static_cast<std::ptrdiff_t>(j) * samples;
    const Eigen::Vector2d first = centre + a * Eigen::Vector2d(-half_ - 1.0, j - half_ - 1.0);
    auto x = static_cast<float>(first.x()), y = static_cast<float>(first.y());
    // What lies outside of the image takes the value of its border, and is not valid.
    for (int i = 0; i < samples; ++i, x += ax, y += ay) {
      row[i] = bilinear(level, within(x, right), within(y, low));
    }
  }
}

void Window::differentiate() {
  const int samples = 2 * half_ + 3;
  for (int j = 0; j < side(); ++j) {
    const float* row = margin_.data() + static_cast<std::ptrdiff_t>(j + 1) * samples + 1;
    const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(j) * stride_;
    for (int i = 0; i < side(); ++i) {
      values_[to + i] = row[i];
      gx_[to + i] = 0.5f * (row[i + 1] - row[i - 1]);
      gy_[to + i] = 0.5f * (row[i + samples] - row[i - samples]);
    }
  }
}

double Window::summarise() {
  double number = 0.0, sum = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < values_.size(); ++k) {
    number += valid_[k];
    sum += static_cast<double>(valid_[k]) * values_[k];
    squares += static_cast<double>(valid_[k]) * values_[k] * values_[k];
  }
  mean_ = number > 0.0 ? sum / number : 0.0;
  contrast_ = number > 0.0 ? std::sqrt(std::max(0.0, squares / number - mean_ * mean_)) : 0.0;
  return number / (static_cast<double>(side()) * side());
}

bool Window::at(double x, double y, float& value) const {
  const double px = x + half_, py = y + half_;
  if (!(px >= 0.0 && py >= 0.0 && px <= 2.0 * half_ && py <= 2.0 * half_)) return false;
  const int u = std::min(static_cast<int>(px), 2 * half_ - 1), v = std::min(static_cast<int>(py), 2 * half_ - 1);
  const auto fx = static_cast<float>(px - u), fy = static_cast<float>(py - v);
  const std::ptrdiff_t above = static_cast<std::ptrdiff_t>(v) * stride_ + u, below = above + stride_;
  if (valid_[above] * valid_[above + 1] * valid_[below] * valid_[below + 1] == 0.0f) return false;
  const float top = values_[above] + fx * (values_[above + 1] - values_[above]),
              bottom = values_[below] + fx * (values_[below + 1] - values_[below]);
  value = top + fy * (bottom - top);
  return true;
}

}  // namespace laparoscope_servo::features
