// What the Linux joystick API (/dev/input/js*, struct js_event) says, taken out of a stream of bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace laparoscope_servo {

struct JoystickEvent {
  enum class Kind { kButton, kAxis };
  Kind kind = Kind::kButton;
  bool initial = false;     // not a hand's: how it stood when the device was opened
  std::uint8_t number = 0;  // of the button or axis, from 0
  std::int16_t value = 0;   // of a button 0 or 1; of an axis -32767 to 32767, right and down are positive
};

class JoystickEvents {
 public:
  // Bytes may end within an event; the rest of it may come later.
  void add(const std::uint8_t* bytes, std::size_t count) { bytes_.insert(bytes_.end(), bytes, bytes + count); }
  // Empty when the next event is not all there. Throws std::runtime_error for bytes that are no event: nothing behind
  // them can be believed.
  std::optional<JoystickEvent> next();
  void clear() { bytes_.clear(); }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace laparoscope_servo
