// The file of a joystick, /dev/input/js*, read without waiting.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace laparoscope_servo {

class JoystickDevice {
 public:
  // Throws std::runtime_error that names the file, and says why it cannot be opened and what to do.
  explicit JoystickDevice(const std::string& path);
  ~JoystickDevice();
  JoystickDevice(const JoystickDevice&) = delete;
  JoystickDevice& operator=(const JoystickDevice&) = delete;

  // As the device calls itself, else its path.
  const std::string& name() const { return name_; }
  // Until there is something to read, at most `seconds`.
  void wait(double seconds) const;
  // What has come, possibly nothing. Throws std::runtime_error when the device is gone.
  std::vector<std::uint8_t> read() const;

 private:
  std::string path_;
  std::string name_;
  int file_;
};

}  // namespace laparoscope_servo
