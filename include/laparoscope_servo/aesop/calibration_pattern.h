// The motion for calibrating the insertion point: out to a cone, round it, and back to the start, by pan and tilt.
// Insertion only keeps the depth, which would otherwise change on the way round because of the arm's delay.
//
// It follows the measured direction of the shaft, so that dead zones and a wrong insertion point change the speed, not
// the path. It ends at the first unexpected measurement. Pure: `now` is seconds of a steady clock.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/aesop/scope_motion.h"

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::aesop {

struct PatternConfig {
  double angle = 0.12;             // rad: half the cone's opening
  double speed = 0.05;             // rad/s
  double max_depth_change = 0.01;  // m, of the depth by the present insertion point
  double patience = 2.0;           // s, largest time without progress towards the next direction
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, PatternConfig& config);

std::vector<std::string> validate(const PatternConfig& config);

class CalibrationPattern {
 public:
  // Starts from the positions `q`. `insertion_point` [m, in aesop_base]: the present one, about which the arm moves.
  CalibrationPattern(const PatternConfig& config, const Kinematics& kinematics, const JointVector& q,
                     const Eigen::Vector3d& insertion_point, double now);

  struct Step {
    scope::Velocity velocity;  // zero when done, and if there is a problem
    bool done = false;
    std::string problem;  // why the pattern ends before it is done
  };
  // `last`: the joint motion for the velocity of the last step. After the end every step returns the end.
  Step step(const JointVector& q, const JointMotion& last, double now);

 private:
  double lever(const Eigen::Isometry3d& base_T_end) const;
  std::string doubt(const Eigen::Isometry3d& base_T_end, const JointMotion& last) const;

  PatternConfig config_;
  const Kinematics kinematics_;
  Eigen::Vector3d insertion_point_;
  std::vector<Eigen::Vector3d> way_;  // unit directions of the shaft, in aesop_base
  std::size_t next_ = 0;
  Eigen::Vector3d start_;
  double start_lever_ = 0.0;
  double nearest_;     // rad, least angle so far between the shaft and way_[next_]
  double nearest_at_;  // s, time of that
  Step end_;
  bool ended_ = false;
};

}  // namespace laparoscope_servo::aesop
