#include "ros/joystick/joystick_events.h"

#include <linux/joystick.h>

#include <cstring>
#include <stdexcept>
#include <string>

namespace laparoscope_servo {

std::optional<JoystickEvent> JoystickEvents::next() {
  js_event raw{};
  if (bytes_.size() < sizeof raw) return std::nullopt;
  std::memcpy(&raw, bytes_.data(), sizeof raw);
  bytes_.erase(bytes_.begin(), bytes_.begin() + sizeof raw);

  const int type = raw.type & ~JS_EVENT_INIT;
  const bool button = type == JS_EVENT_BUTTON && (raw.value == 0 || raw.value == 1);
  if (!button && type != JS_EVENT_AXIS) {
    throw std::runtime_error("type " + std::to_string(raw.type) + ", value " + std::to_string(raw.value) +
                             " is no event of the joystick API; the device has to be one of /dev/input/js*");
  }
  JoystickEvent event;
  event.kind = button ? JoystickEvent::Kind::kButton : JoystickEvent::Kind::kAxis;
  event.initial = (raw.type & JS_EVENT_INIT) != 0;
  event.number = raw.number;
  event.value = raw.value;
  return event;
}

}  // namespace laparoscope_servo
