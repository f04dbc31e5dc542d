// The motion by which a scope shows where its insertion point is: out to a cone, round it, back to where it was, by pan
// and tilt. Insertion only keeps the depth, which the arm's delay would change on the way round.
//
// It follows the measured direction of the shaft, so that dead zones and a wrong insertion point change the speed, not
// the way; and it ends at the first sign that something is not as expected. Pure: `now` is seconds of a steady clock.
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
  double max_depth_change = 0.01;  // m: of the depth by the insertion point believed in
  double patience = 2.0;           // s, without coming nearer to the next direction
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, PatternConfig& config);

std::vector<std::string> validate(const PatternConfig& config);

class CalibrationPattern {
 public:
  // Starts from the positions `q`. `insertion_point` [m, in aesop_base] is the one that the arm is driven about.
  CalibrationPattern(const PatternConfig& config, const Kinematics& kinematics, const JointVector& q,
                     const Eigen::Vector3d& insertion_point, double now);

  struct Step {
    scope::Velocity velocity;  // zero when done or when there is a problem
    bool done = false;
    std::string problem;  // why the pattern ends before it is done
  };
  // `last`: what became of the velocity of the last step. After the end, nothing but the end comes.
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
  double nearest_;     // rad, that the shaft has come to way_[next_]
  double nearest_at_;  // s, when
  Step end_;
  bool ended_ = false;
};

}  // namespace laparoscope_servo::aesop
