#include "ros/joystick/joystick_device.h"

#include <fcntl.h>
#include <linux/joystick.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace laparoscope_servo {

namespace {

std::string whyNot(int error) {
  std::string text = std::strerror(error);
  if (error == EACCES) text += "; its group, often input, may read it (ls -l)";
  return text;
}

}  // namespace

JoystickDevice::JoystickDevice(const std::string& path)
    : path_(path), name_(path), file_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
  if (file_ < 0) throw std::runtime_error("'" + path + "' cannot be opened: " + whyNot(errno));
  std::array<char, 128> name{};
  if (::ioctl(file_, JSIOCGNAME(name.size() - 1), name.data()) > 0) name_ = name.data();
}

JoystickDevice::~JoystickDevice() {
  ::close(file_);
}

void JoystickDevice::wait(double seconds) const {
  pollfd file{file_, POLLIN, 0};
  ::poll(&file, 1, static_cast<int>(std::ceil(1e3 * std::max(seconds, 0.0))));
}

std::vector<std::uint8_t> JoystickDevice::read() const {
  std::vector<std::uint8_t> bytes(64 * sizeof(js_event));  // as many events as the kernel keeps for a reader
  const ssize_t count = ::read(file_, bytes.data(), bytes.size());
  if (count == 0) throw std::runtime_error("'" + path_ + "' has ended");
  if (count < 0 && errno != EAGAIN && errno != EINTR)
    throw std::runtime_error("'" + path_ + "' is gone: " + whyNot(errno));
  bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  return bytes;
}

}  // namespace laparoscope_servo
