// Computes a joystick's messages to the controller: a dead-man switch and four velocities.
//
// On any doubt it publishes nothing, so that the arm stops: until every axis and button in use has been reported and
// was seen released once; if no event comes for long although a control is held or deflected, since a hand is never
// that still, but a pad out of radio range is; and if the device is gone. Controls that are held or deflected at the
// start have no effect.
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
  // Messages to publish now.
  struct Words {
    std::vector<bool> dead_man;  // dead_man messages in this order, see DeadManWords
    std::optional<scope::Velocity> manual;
  };

  explicit Stick(const StickConfig& config) : config_(config) {}

  // Takes an event. Returns true if a control was released, which must be published at once. `now`: s, steady.
  bool event(const JoystickEvent& event, double now);
  // Call when the device is gone.
  void gone();
  // Call at least 20 times a second.
  Words cycle(double now);

  // Why nothing may be published; empty: it may.
  const std::string& problem() const { return problem_; }
  bool isHeld() const { return dead_man_.isHeld(); }

 private:
  // Deflection from -1 to 1; 0 up to the bound of neutral, and for an unused axis.
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
  bool ready_ = false;       // all controls were seen released
  DeadManWords dead_man_;
  bool was_active_ = false;
  bool drives_ = false;  // the stick was active and at rest
  int manual_farewells_ = 0;
  std::string problem_ = "no joystick";
};

}  // namespace laparoscope_servo
