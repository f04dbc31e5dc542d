// The file of a joystick, /dev/input/js*, read without waiting.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace laparoscope_servo {

class JoystickDevice {
 public:
  // Throws std::runtime_error with the file, why it cannot be opened, and what to do.
  explicit JoystickDevice(const std::string& path);
  ~JoystickDevice();
  JoystickDevice(const JoystickDevice&) = delete;
  JoystickDevice& operator=(const JoystickDevice&) = delete;

  // The device's own name, or else its path.
  const std::string& name() const { return name_; }
  // Waits until there is data, at most `seconds`.
  void wait(double seconds) const;
  // The bytes received, possibly none. Throws std::runtime_error if the device is gone.
  std::vector<std::uint8_t> read() const;

 private:
  std::string path_;
  std::string name_;
  int file_;
};

}  // namespace laparoscope_servo
