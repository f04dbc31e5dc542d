#include "features/points/point_flow.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace laparoscope_servo::features {

namespace {

constexpr int kMaxIterations = 8;
constexpr double kStep = 0.03;          // px of the level: smaller steps end the iteration
constexpr double kLeastShare = 0.5;     // of a window that has to be valid
constexpr double kLeastGradient = 0.5;  // grey levels per px, root mean square along the direction with the least
constexpr double kMaxContrast = 2.0;    // ratio of the contrasts, for light that changes at once

Eigen::Matrix2d levelShape(int l) {
  return static_cast<double>(1 << l) * Eigen::Matrix2d::Identity();
}

}  // namespace

void FlowMemory::keep(const PointImage& image, const Eigen::Vector2d& place, int half) {
  const auto count = static_cast<std::size_t>(image.levels());
  if (windows_.size() != count) {
    windows_.assign(count, Window(half));
    shares_.assign(count, 0.0);
  }
  kept_ = image.levels();
  for (int l = 0; l < kept_; ++l) {
    const auto k = static_cast<std::size_t>(l);
    shares_[k] = windows_[k].sample(image, l, place, levelShape(l));
  }
}

bool PointFlow::follow(const FlowMemory& memory, const PointImage& image, int finest, Eigen::Vector2d& place) {
  bool found = false;
  for (int l = std::min(memory.levels(), image.levels()) - 1; l >= finest; --l) {
    if (memory.share(l) >= kLeastShare && followAt(memory.window(l), image, l, place)) found = true;
  }
  return found;
}

// The windows' difference after their means and contrasts were made equal, so that a change of the light does not look
// like a motion; `right`: its sum with the gradient, the right side of the normal equations.
double PointFlow::mismatch(const Window& before, Eigen::Vector2d* right) {
  const double ratio = before.contrast() / std::max(now_.contrast(), 1e-3);
  const auto gain = static_cast<float>(std::clamp(ratio, 1.0 / kMaxContrast, kMaxContrast));
  const auto offset = static_cast<float>(before.mean() - gain * now_.mean());
  float squares = 0.0f, x = 0.0f, y = 0.0f, number = 0.0f;
  const float *then = before.values(), *now = now_.values(), *gx = before.gradientX(), *gy = before.gradientY();
  const float *then_valid = before.valid(), *now_valid = now_.valid();
#pragma omp simd reduction(+ : squares, x, y, number)
  for (int k = 0; k < before.count(); ++k) {
    const float valid = then_valid[k] * now_valid[k], r = gain * now[k] + offset - then[k];
    squares += valid * r * r;
    x += valid * r * gx[k];
    y += valid * r * gy[k];
    number += valid;
  }
  *right = Eigen::Vector2d(x, y);
  if (!(number > kLeastShare * before.side() * before.side())) return std::numeric_limits<double>::infinity();
  return squares / number;
}

bool PointFlow::followAt(const Window& before, const PointImage& image, int l, Eigen::Vector2d& place) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();  // R of eq. (2)
  double number = 0.0;
  for (int k = 0; k < before.count(); ++k) {
    const double gx = before.gradientX()[k], gy = before.gradientY()[k], w = before.valid()[k];
    normal(0, 0) += w * gx * gx;
    normal(0, 1) += w * gx * gy;
    normal(1, 1) += w * gy * gy;
    number += w;
  }
  normal(1, 0) = normal(0, 1);
  const double half_trace = 0.5 * normal.trace();
  const double least = half_trace - std::sqrt(std::max(0.0, half_trace * half_trace - normal.determinant()));
  if (!(least > number * kLeastGradient * kLeastGradient)) return false;
  const Eigen::Matrix2d inverse = normal.inverse();

  const double size = 1 << l;
  Eigen::Vector2d right, moved = place;
  now_.sample(image, l, moved, levelShape(l));
  const double first = mismatch(before, &right);
  if (!std::isfinite(first)) return false;
  double last = first, step = 0.0;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Eigen::Vector2d d = -inverse * right;
    step = d.norm();
    moved += size * d;
    now_.sample(image, l, moved, levelShape(l));
    last = mismatch(before, &right);
    if (!std::isfinite(last)) return false;
    if (!(step > kStep)) break;
  }
  // A level on which it only got worse has no say.
  if (!(last <= first)) return false;
  place = moved;
  return true;
}

}  // namespace laparoscope_servo::features
