// What a joystick says to the controller: a dead-man switch and four velocities.
//
// It fails towards silence, on which the arm stands: until every axis and button that is used has been reported and was
// seen released once; when nothing comes for long although something is held or deflected, for a hand is never so still
// and a pad out of reach is; and when the device is gone. What is held or deflected at the start counts for nothing.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/scope/velocity.h"
#include "ros/common/hold_words.h"
#include "ros/joystick/joystick_events.h"
#include "ros/joystick/stick_config.h"

namespace laparoscope_servo {

class Stick {
 public:
  // To be published now.
  struct Words {
    std::vector<bool> dead_man;  // in this order, see DeadManWords
    std::optional<scope::Velocity> manual;
  };

  explicit Stick(const StickConfig& config) : config_(config) {}

  // True when something was let go, which is to be said at once. `now`: s, steady.
  bool event(const JoystickEvent& event, double now);
  // The device is not there any more.
  void gone();
  // To be called 20 times a second or more.
  Words turn(double now);

  // Why nothing may be said; empty when all is well.
  const std::string& problem() const { return problem_; }
  bool isHeld() const { return dead_man_.isHeld(); }

 private:
  // -1 to 1, 0 up to the bound of neutral; of one that is not used 0.
  double shareOf(const StickConfig::Axis& axis) const;
  bool pressed() const;
  bool deflected() const;
  std::string missing() const;
  std::string judge(double now);
  std::optional<scope::Velocity> manualWord(bool active);

  StickConfig config_;
  std::map<int, int> axes_;  // -32767 to 32767, by number
  std::map<int, bool> buttons_;
  double last_event_ = 0.0;  // s
  bool ready_ = false;       // everything was seen released
  DeadManWords dead_man_;
  bool was_active_ = false;
  bool drives_ = false;  // it was active and at rest
  int manual_farewells_ = 0;
  std::string problem_ = "no joystick";
};

}  // namespace laparoscope_servo
