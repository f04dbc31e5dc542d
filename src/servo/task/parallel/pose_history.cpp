#include "servo/task/parallel/pose_history.h"

#include <cmath>

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::servo {

namespace {

constexpr double kKept = 2.0;  // s, longer than an image is old and a pose is waited for

}  // namespace

void PoseHistory::add(double time, const Eigen::Isometry3d& base_T_shaft) {
  if (!std::isfinite(time) || !base_T_shaft.matrix().allFinite()) return;
  if (!poses_.empty() && !(time > poses_.back().time)) return;
  poses_.push_back({time, base_T_shaft});
  while (poses_.front().time < time - kKept) poses_.pop_front();
}

std::optional<Eigen::Isometry3d> PoseHistory::at(double time) const {
  const Pose* nearest = nullptr;
  bool is_between = false;
  for (const Pose& pose : poses_) {
    if (pose.time <= time) is_between = true;
    if (nearest == nullptr || std::abs(pose.time - time) < std::abs(nearest->time - time)) nearest = &pose;
  }
  if (!is_between || !reaches(time)) return std::nullopt;
  // The line's value at `time`, of the rotation vector from the nearest pose and of the place.
  double count = 0.0, times = 0.0, squares = 0.0;
  geometry::Vector6d sum = geometry::Vector6d::Zero(), product = geometry::Vector6d::Zero();
  for (const Pose& pose : poses_) {
    const double t = pose.time - time;
    if (std::abs(t) > kReach) continue;
    geometry::Vector6d value;
    value << geometry::so3Log(nearest->base_T_shaft.linear().transpose() * pose.base_T_shaft.linear()),
        pose.base_T_shaft.translation();
    count += 1.0;
    times += t;
    squares += t * t;
    sum += value;
    product += t * value;
  }
  const double determinant = count * squares - times * times;
  if (count < 3.0 || !(determinant > 0.0)) return std::nullopt;
  const geometry::Vector6d value = (squares * sum - times * product) / determinant;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = nearest->base_T_shaft.linear() * geometry::so3Exp(value.head<3>());
  pose.translation() = value.tail<3>();
  return pose;
}

}  // namespace laparoscope_servo::servo
