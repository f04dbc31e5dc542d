// Whether the pose of the scope, as it is told, can be that of an arm that is driven slowly.
//
// While the controller is engaged, a pose that is further from the last one than the arm moves in that time is not
// used: the scope was moved by hand, or somebody else tells its pose. It may be one stray message; a jump that stays,
// or that comes again and again, is a fault. What the camera is on the shaft must not change at all. While not engaged,
// the arm may be moved by hand as fast as one likes: nothing is judged, and engaging starts from the pose of that
// moment.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "laparoscope_servo/servo/safety_config.h"

namespace laparoscope_servo::servo {

class PoseWatch {
 public:
  // Both texts stay as they are while the cause lasts. Empty: nothing is wrong.
  struct Verdict {
    std::string problem;  // why this pose must not be used
    std::string fault;    // why none must be used before somebody has looked
  };

  // Uses max_tip_speed [m/s], max_tip_turn [rad/s], max_optics_offset [m] and max_depth_age [s].
  explicit PoseWatch(const SafetyConfig& config) : config_(config) {}

  // `stamp`: s, when the pose was so; `now`: s, on a clock that never jumps; `engaged`: whether it is judged.
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
  std::optional<Pose> last_;  // that was used
  Eigen::Isometry3d optics_ = Eigen::Isometry3d::Identity();
  std::string jump_;         // the one that lasts; empty: none
  double jump_since_ = 0.0;  // s
  int jumps_ = 0;            // not long ago
};

}  // namespace laparoscope_servo::servo
