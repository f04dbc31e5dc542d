#include "laparoscope_servo/servo/task_error_input.h"

#include <cmath>

namespace laparoscope_servo::servo {

namespace {

constexpr double kFarthest = 5.0;   // 79 degrees off the axis: more than a pinhole camera shows
constexpr double kDeepest = 3.0;    // log depth: 20 times as far, or as near, as at the reference
constexpr double kRounding = 1e-6;  // tolerance for values from a message

bool within(double value, double bound) {
  return std::abs(value) <= bound;  // false for NaN
}

}  // namespace

std::string implausible(const TaskErrorInput& input) {
  const TaskError& e = input.error;
  if (!isFinite(e)) return "task error is not finite";
  if (!within(e.x, kFarthest) || !within(e.y, kFarthest)) return "task error: x or y is not within 5";
  if (!within(e.desired_x, kFarthest) || !within(e.desired_y, kFarthest)) {
    return "task error: desired_x or desired_y is not within 5";
  }
  if (!within(e.log_depth, kDeepest) || !within(e.desired_log_depth, kDeepest)) {
    return "task error: log_depth or desired_log_depth is not within 3";
  }
  if (!within(e.alpha, M_PI + kRounding) || !within(e.desired_alpha, M_PI + kRounding)) {
    return "task error: alpha or desired_alpha is not within pi";
  }
  if (!within(e.m_star.z() - 1.0, kRounding) || !within(e.m_star.x(), kFarthest) || !within(e.m_star.y(), kFarthest)) {
    return "task error: m_star is not (x, y, 1) within 5";
  }
  // m* + e_v is H m*, a point in front of the camera; its z is the ratio of the depths.
  if (!(1.0 + e.e_v.z() > 0.0)) return "task error: e_v puts the region behind the camera";
  if (!within(std::log(1.0 + e.e_v.z()), kDeepest)) return "task error: the depth in e_v is not possible";
  const double farthest = kFarthest * (2.0 + e.e_v.z());  // bound on m* + e_v, plus one on m*
  if (!within(e.e_v.x(), farthest) || !within(e.e_v.y(), farthest)) return "task error: e_v is not possible";
  if (!(input.visible_fraction >= 0.0 && input.visible_fraction <= 1.0 + kRounding)) {
    return "task error: visible_fraction is not within 0 and 1";
  }
  return input.corner_error >= 0.0 ? "" : "task error: corner_error is not 0 or more";
}

}  // namespace laparoscope_servo::servo
