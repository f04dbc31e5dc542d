// Checks whether the published pose of the scope is plausible for an arm that moves slowly.
//
// While the controller is engaged, a pose is not used if it is further from the last one than the arm can move in that
// time: the scope was moved by hand, or another node publishes its pose. A single jump may be a stray message; a jump
// that lasts or recurs is a fault. The pose of the camera on the shaft must not change at all. While not engaged,
// nothing is checked, since the arm may be moved by hand; engaging starts from the pose of that moment.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "laparoscope_servo/servo/safety_config.h"

namespace laparoscope_servo::servo {

class PoseWatch {
 public:
  // Both texts do not change while the cause lasts. Empty: nothing is wrong.
  struct Verdict {
    std::string problem;  // why this pose must not be used
    std::string fault;    // why no pose must be used before an operator has looked at the arm
  };

  // Uses max_tip_speed [m/s], max_tip_turn [rad/s], max_optics_offset [m] and max_depth_age [s].
  explicit PoseWatch(const SafetyConfig& config) : config_(config) {}

  // `stamp`: s, time of the pose; `now`: s, on a clock that never jumps; `engaged`: false if nothing is checked.
  Verdict judge(double stamp, double now, const Eigen::Isometry3d& insertion_point_T_tip,
                const Eigen::Isometry3d& camera_T_shaft, bool engaged);

 private:
  struct Pose {
    double stamp = 0.0;  // s
    Eigen::Isometry3d insertion_point_T_tip;
  };

  std::string opticsProblem(const Eigen::Isometry3d& camera_T_shaft) const;
  std::string jump(double stamp, const Eigen::Isometry3d& insertion_point_T_tip) const;
  Verdict judgeJump(const std::string& jump, double now);

  SafetyConfig config_;
  std::optional<Pose> last_;  // the last pose that was used
  Eigen::Isometry3d optics_ = Eigen::Isometry3d::Identity();
  std::string jump_;         // text of the jump that lasts; empty: none
  double jump_since_ = 0.0;  // s
  int jumps_ = 0;            // number of recent jumps
};

}  // namespace laparoscope_servo::servo
