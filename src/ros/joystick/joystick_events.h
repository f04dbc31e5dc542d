// Decodes events of the Linux joystick API (/dev/input/js*, struct js_event) from a stream of bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace laparoscope_servo {

struct JoystickEvent {
  enum class Kind { kButton, kAxis };
  Kind kind = Kind::kButton;
  bool initial = false;     // initial state when the device was opened, not caused by a hand
  std::uint8_t number = 0;  // number of the button or axis, from 0
  std::int16_t value = 0;   // button: 0 or 1; axis: -32767 to 32767, right and down are positive
};

class JoystickEvents {
 public:
  // Bytes may end within an event; the rest may come later.
  void add(const std::uint8_t* bytes, std::size_t count) { bytes_.insert(bytes_.end(), bytes, bytes + count); }
  // Empty if the next event is incomplete. Throws std::runtime_error for bytes that are no event, since the following
  // bytes cannot be decoded.
  std::optional<JoystickEvent> next();
  void clear() { bytes_.clear(); }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace laparoscope_servo
