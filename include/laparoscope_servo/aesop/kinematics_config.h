// The arm's geometry. Defaults are those of config/aesop.yaml: an AESOP 3000 from a public calibration demo of unknown
// accuracy. They are nominal only; calibrate your own arm.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::aesop {

constexpr int kJoints = 7;

// Joint positions (m for a prismatic joint, else rad) or velocities (m/s, rad/s), joint 1 first.
using JointVector = Eigen::Matrix<double, kJoints, 1>;

enum class JointRole {
  kDriven,   // moved by a motor on command
  kHand,     // set by hand and then locked
  kPassive,  // free: the trocar moves it
  kBoth,     // listed as driven and as by hand in a file: validate() refuses it
};

// One row of a standard Denavit-Hartenberg table: Rz(theta) Tz(d) Tx(a) Rx(alpha), the joint's position added to theta,
// or to d when prismatic.
struct DhJoint {
  bool prismatic;
  JointRole role;
  double alpha;      // rad
  double a;          // m
  double d;          // m, offset when prismatic
  double theta;      // rad, offset when revolute
  double minimum;    // m or rad
  double maximum;    // m or rad
  double max_speed;  // m/s or rad/s, > 0
};

// Defaults of the seven joints; joint 7 turns the scope, and O_7 lies 0.1 m along it from the wrist.
std::array<DhJoint, kJoints> nominalJoints();

struct KinematicsConfig {
  std::array<DhJoint, kJoints> joints = nominalJoints();
  // l, from O_7 to the centre of the camera along the shaft, which is the z axis of frame 7. 0 to 1 m, exclusive.
  double scope_length = 0.30;
  // Range of the camera's depth d2 [m]: 0 < minimum < maximum < scope_length.
  double depth_minimum = 0.03;
  double depth_maximum = 0.22;
};

// Limits at which a motion is slowed, and at which it is refused; both apply only to motion towards the limit.
struct MotionConfig {
  double limit_margin_angle = 0.087;    // rad, > 0: slowed from here to a revolute joint's limit
  double limit_margin_distance = 0.02;  // m, > 0: the same for prismatic joints and for the depth of the scope
  // Limits of the smallest singular value of the 6x6 Jacobian with lengths divided by 0.3 m; it is about 0.6 at the
  // nominal start pose.
  double singular_slow = 0.20;
  double singular_stop = 0.10;  // > 0, < singular_slow
  // Limits of d1: the shorter it is, the further the scope turns for the same motion of the arm, and the larger is the
  // effect of a wrong insertion point. m, 0.01 < stop < slow < 0.3; for pan, tilt and deeper only.
  double lever_slow = 0.05;
  double lever_stop = 0.03;
  // s, 0.05 to 5, from a command to joints at rest: speed is limited so that no limit is reached within this time, and
  // the arm's delay leads no joint beyond its limit.
  double stopping_time = 0.5;
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, KinematicsConfig& config);
void describe(parameters::Table& table, MotionConfig& config);

// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const KinematicsConfig& config);
std::vector<std::string> validate(const MotionConfig& config);

}  // namespace laparoscope_servo::aesop
