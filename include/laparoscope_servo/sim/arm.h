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
  // Joint positions at power-on; those of the passive joints are a first guess, the trocar decides. m, rad
  aesop::JointVector start = (aesop::JointVector() << 0.25, -0.9, 1.5, 0.0, 0.0, 0.0, 0.0).finished();
  Eigen::Vector3d insertion_point{0.574, -0.079, -0.05};  // m, in aesop_base: where the trocar really is
  double delay = 0.16;                                    // s: from a command to its effect, as the paper measured
  // A commanded speed up to here moves nothing; m/s, rad/s, of the driven joints. At the nominal start pose these are
  // about 4 mrad/s and 0.4 mm/s of the scope.
  aesop::JointVector dead_zone = (aesop::JointVector() << 4e-4, 3e-3, 3e-3, 0.0, 0.0, 0.0, 4e-3).finished();
  double breakaway = 1.25;      // friction; a joint at rest needs this many times its dead zone to start
  double time_constant = 0.03;  // s: of a joint following its speed
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, ArmConfig& config);

std::vector<std::string> validate(const ArmConfig& config);

class Arm {
 public:
  // Throws std::invalid_argument: errors of the configuration, or a start pose that joint limits or the trocar do not
  // allow.
  Arm(const aesop::Kinematics& kinematics, const ArmConfig& config);

  // Speeds of the driven joints, in the order of the arm; they take effect `delay` after `now`, until the next ones do.
  void command(const std::array<double, aesop::kDrivenJoints>& speed, double now);
  // Stands at once and forgets what was on its way: the brakes of a fault.
  void brake();
  // A motor that does nothing any more, whatever is commanded: index 0 to 6; -1 for none.
  void jam(int joint) { jammed_ = joint; }
  // A hand moves the scope about the trocar by pan, tilt, spin [rad] and insertion [m] in `seconds`, evenly. Says why
  // not.
  std::string hand(const scope::Velocity& displacement, double seconds, double now);
  // Lets time pass until `now`.
  void step(double now);

  const aesop::JointVector& position() const { return q_; }
  const aesop::JointVector& velocity() const { return qdot_; }
  bool isMoving() const;
  bool isInHand() const { return hand_left_ > 0.0; }
  // s: until when a driven joint has moved by its motor; -infinity before.
  double movedUntil() const { return moved_until_; }
  // Why the arm cannot follow, e.g. the wrist has reached its limit; empty when it can. brake() forgets it.
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
  double moved_until_ = -std::numeric_limits<double>::infinity();
  double now_ = 0.0;
  bool started_ = false;
  std::string stuck_;
};

}  // namespace laparoscope_servo::sim
