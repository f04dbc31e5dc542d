// The shaft's poses of the last seconds, and the pose at the time of an image.
#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <optional>

namespace laparoscope_servo::servo {

class PoseHistory {
 public:
  // s: a pose is the line through those up to so long before and after it. That takes out the noise of single poses; on
  // a circle of 4 s the line is 0.4 % of the radius off.
  static constexpr double kReach = 0.1;

  // Times must increase; an earlier or equal one, or a pose that is not finite, is ignored.
  void add(double time, const Eigen::Isometry3d& base_T_shaft);
  void clear() { poses_.clear(); }

  // Whether a pose later than that by kReach has come.
  bool reaches(double time) const { return !poses_.empty() && poses_.back().time >= time + kReach; }
  // The pose at a time that is reached; empty where fewer than three poses lie about it, or none before it.
  std::optional<Eigen::Isometry3d> at(double time) const;

 private:
  struct Pose {
    double time;  // s
    Eigen::Isometry3d base_T_shaft;
  };
  std::deque<Pose> poses_;
};

}  // namespace laparoscope_servo::servo
