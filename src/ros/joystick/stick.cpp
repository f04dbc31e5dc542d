#include "ros/joystick/stick.h"

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/validation/range.h"

namespace laparoscope_servo {

namespace {

constexpr double kFull = 32767.0;

}  // namespace

bool Stick::event(const JoystickEvent& event, double now) {
  const bool was_pressed = pressed();
  const bool was_deflected = deflected();
  if (event.kind == JoystickEvent::Kind::kButton) {
    buttons_[event.number] = event.value != 0;
  } else {
    axes_[event.number] = event.value;
  }
  last_event_ = now;
  return (was_pressed && !pressed()) || (was_deflected && !deflected());
}

void Stick::gone() {
  axes_.clear();
  buttons_.clear();
  ready_ = false;
}

double Stick::shareOf(const StickConfig::Axis& axis) const {
  const auto found = axes_.find(axis.axis);
  if (found == axes_.end()) return 0.0;
  const double share = std::clamp(found->second / kFull, -1.0, 1.0) * (axis.reversed ? -1.0 : 1.0);
  const double beyond = std::abs(share) - config_.neutral;
  return beyond > 0.0 ? std::copysign(beyond / (1.0 - config_.neutral), share) : 0.0;
}

bool Stick::pressed() const {
  const auto held = [this](int button) {
    const auto found = buttons_.find(button);
    return found != buttons_.end() && found->second;
  };
  if (held(config_.dead_man_button) || held(config_.pedal_button)) return true;
  const auto pedal = axes_.find(config_.pedal_axis);
  if (pedal == axes_.end()) return false;
  const double share = 0.5 + 0.5 * (config_.pedal_reversed ? -1.0 : 1.0) * pedal->second / kFull;
  return share >= config_.pedal_pressed;
}

bool Stick::deflected() const {
  for (const auto* axis : {&config_.pan, &config_.tilt, &config_.spin, &config_.insertion}) {
    if (shareOf(*axis) != 0.0) return true;
  }
  return false;
}

// Axes and buttons that are used but have not been reported: the device does not have them, or has not reported them
// yet.
std::string Stick::missing() const {
  for (const int axis :
       {config_.pan.axis, config_.tilt.axis, config_.spin.axis, config_.insertion.axis, config_.pedal_axis}) {
    if (axis >= 0 && axes_.count(axis) == 0) return "axis " + std::to_string(axis);
  }
  for (const int button : {config_.dead_man_button, config_.pedal_button}) {
    if (button >= 0 && buttons_.count(button) == 0) return "button " + std::to_string(button);
  }
  return "";
}

std::string Stick::judge(double now) {
  if (axes_.empty() && buttons_.empty()) return "no joystick";
  const std::string lacks = missing();
  if (!lacks.empty()) {
    ready_ = false;
    return "the joystick does not report " + lacks + ", which is used";
  }
  const bool at_rest = !pressed() && !deflected();
  if (!at_rest && !(now - last_event_ <= config_.max_silence)) {
    ready_ = false;
    return "nothing came for " + validation::numberText(config_.max_silence) +
           " s though something is held or deflected: out of reach? Release everything once";
  }
  ready_ = ready_ || at_rest;
  return ready_ ? "" : "held or deflected from the start: release everything once";
}

Stick::Words Stick::cycle(double now) {
  problem_ = judge(now);
  const bool held = ready_ && pressed();
  const bool has_axes =
      config_.pan.axis >= 0 || config_.tilt.axis >= 0 || config_.spin.axis >= 0 || config_.insertion.axis >= 0;
  const bool active = has_axes && ready_ && (held || !config_.only_while_held);
  Words words{dead_man_.turn(held), manualWord(active)};
  if (active && !drives_) problem_ = "the stick was deflected when the switch was taken: release the stick once";
  return words;
}

// The first message is zero, because the controller accepts only a stick that it has seen at rest.
std::optional<scope::Velocity> Stick::manualWord(bool active) {
  if (drives_ && !active) manual_farewells_ = kFarewellZeros;
  drives_ = active && ((was_active_ && drives_) || !deflected());
  was_active_ = active;
  scope::Velocity velocity;
  if (drives_) {
    velocity.pan = shareOf(config_.pan) * config_.pan.velocity;
    velocity.tilt = shareOf(config_.tilt) * config_.tilt.velocity;
    velocity.spin = shareOf(config_.spin) * config_.spin.velocity;
    velocity.insertion = shareOf(config_.insertion) * config_.insertion.velocity;
    manual_farewells_ = 0;
    return velocity;
  }
  if (manual_farewells_ == 0) return std::nullopt;
  --manual_farewells_;
  return velocity;
}

}  // namespace laparoscope_servo
