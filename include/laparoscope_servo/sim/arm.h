// The emulated arm: joints that follow velocities late and imperfectly, and a passive wrist that the trocar holds.
//
// Pure: time is an argument, in seconds from any start, and the same calls give the same motion.
#pragma once

#include <array>
#include <deque>
#include <limits>
#include <string>
#include <vector>

#include "laparoscope_servo/aesop/messages.h"
#include "laparoscope_servo/aesop/scope_motion.h"

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::sim {

struct ArmConfig {
  // Joint positions at power-on; those of the passive joints are initial values for the solution at the trocar. m, rad
  aesop::JointVector start = (aesop::JointVector() << 0.25, -0.9, 1.5, 0.0, 0.0, 0.0, 0.0).finished();
  Eigen::Vector3d insertion_point{0.574, -0.079, -0.05};  // m, in aesop_base: the true position of the trocar
  double delay = 0.16;                                    // s: from a command to its effect, measured in the paper
  // Speeds of the driven joints up to this cause no motion; m/s, rad/s. At the nominal start pose these are about 4
  // mrad/s and 0.4 mm/s of the scope.
  aesop::JointVector dead_zone = (aesop::JointVector() << 4e-4, 3e-3, 3e-3, 0.0, 0.0, 0.0, 4e-3).finished();
  double breakaway = 1.25;      // friction: factor on the dead zone for a joint to start from rest
  double time_constant = 0.03;  // s, with which a joint follows its speed
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, ArmConfig& config);

std::vector<std::string> validate(const ArmConfig& config);

class Arm {
 public:
  // Throws std::invalid_argument for errors of the configuration, or a start pose that is impossible because of joint
  // limits or the trocar.
  Arm(const aesop::Kinematics& kinematics, const ArmConfig& config);

  // Speeds of the driven joints, in the order of the arm; they take effect `delay` after `now`, and last until the next
  // ones. Throws std::invalid_argument for a speed that is not finite, which would put a joint at its limit at once.
  void command(const std::array<double, aesop::kDrivenJoints>& speed, double now);
  // Stops at once and drops delayed commands: the brakes of a fault.
  void brake();
  // Makes a motor ignore its commands: index 0 to 6; -1 for none.
  void jam(int joint) { jammed_ = joint; }
  // Makes a motor turn the other way than it is told: index 0 to 6; -1 for none.
  void reverse(int joint) { reversed_ = joint; }
  // The joints move by this factor of their commands, negative: the other way.
  // Throws std::invalid_argument if it is not finite.
  void setGain(double gain);
  // Commands take effect so much [s] later than by the configuration, never before an earlier one.
  // Throws std::invalid_argument if it is not finite.
  void setLag(double lag);
  // Moves the scope by hand about the trocar, by pan, tilt, spin [rad] and insertion [m], evenly within `seconds`.
  // Returns why not, or an empty text.
  std::string hand(const scope::Velocity& displacement, double seconds, double now);
  // Simulates the time until `now`.
  void step(double now);

  const aesop::JointVector& position() const { return q_; }
  const aesop::JointVector& velocity() const { return qdot_; }
  bool isMoving() const;
  bool isInHand() const { return hand_left_ > 0.0; }
  // s: last time at which a motor moved a driven joint; -infinity: never.
  double movedUntil() const { return moved_until_; }
  // Why the arm cannot follow, e.g. the wrist has reached its limit; else empty. brake() clears it.
  const std::string& stuck() const { return stuck_; }

 private:
  struct Pending {
    double at;
    std::array<double, aesop::kDrivenJoints> speed;
  };

  void advance(double dt);
  aesop::JointVector drivenVelocity(double dt) const;
  aesop::JointVector handVelocity(double dt);

  const aesop::Kinematics kinematics_;
  ArmConfig config_;
  aesop::JointVector q_ = aesop::JointVector::Zero();
  aesop::JointVector qdot_ = aesop::JointVector::Zero();
  std::deque<Pending> pending_;
  std::array<double, aesop::kDrivenJoints> target_{};
  scope::Velocity hand_;
  double hand_left_ = 0.0;
  int jammed_ = -1;
  int reversed_ = -1;
  double gain_ = 1.0;
  double lag_ = 0.0;  // s
  double moved_until_ = -std::numeric_limits<double>::infinity();
  double now_ = 0.0;
  bool started_ = false;
  std::string stuck_;
};

}  // namespace laparoscope_servo::sim
