#include "sim/arm/pty.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace laparoscope_servo::sim {

namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

}  // namespace

Pty::Pty(const std::string& link) : link_(link) {
  master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (master_ < 0) fail("no pseudo-terminal");
  std::array<char, 128> name{};
  if (::grantpt(master_) != 0 || ::unlockpt(master_) != 0 || ::ptsname_r(master_, name.data(), name.size()) != 0) {
    const int cause = errno;
    close();
    errno = cause;
    fail("cannot open the far end of a pseudo-terminal");
  }
  device_ = name.data();
  slave_ = ::open(device_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings{};
  if (slave_ >= 0 && ::tcgetattr(slave_, &settings) == 0) {
    ::cfmakeraw(&settings);  // otherwise the line would echo
    ::tcsetattr(slave_, TCSANOW, &settings);
  }
  struct stat existing {};
  const bool occupied = ::lstat(link_.c_str(), &existing) == 0;
  if (occupied && !S_ISLNK(existing.st_mode)) {
    close();
    throw std::runtime_error("'" + link_ + "' exists and is no symbolic link, expected a free name for the port");
  }
  if (occupied) ::unlink(link_.c_str());
  if (::symlink(device_.c_str(), link_.c_str()) != 0) {
    const int cause = errno;
    close();
    errno = cause;
    fail("cannot make the link '" + link_ + "'");
  }
}

Pty::~Pty() {
  // The link may have been replaced since.
  std::array<char, 128> target{};
  const ssize_t length = ::readlink(link_.c_str(), target.data(), target.size() - 1);
  if (length > 0 && device_ == target.data()) ::unlink(link_.c_str());
  close();
}

void Pty::close() {
  if (slave_ >= 0) ::close(slave_);
  if (master_ >= 0) ::close(master_);
  slave_ = master_ = -1;
}

aesop::Bytes Pty::read() {
  aesop::Bytes bytes;
  std::array<std::uint8_t, 512> piece{};
  for (ssize_t count = 0; (count = ::read(master_, piece.data(), piece.size())) > 0;) {
    bytes.insert(bytes.end(), piece.begin(), piece.begin() + count);
  }
  return bytes;
}

void Pty::write(const aesop::Bytes& bytes) {
  const ssize_t written = ::write(master_, bytes.data(), bytes.size());
  // Nobody reads: drops the waiting bytes, so that a later client does not read stale data.
  if (written < static_cast<ssize_t>(bytes.size())) ::tcflush(slave_, TCIFLUSH);
}

int Pty::duplicate() const {
  const int copy = ::fcntl(master_, F_DUPFD_CLOEXEC, 0);
  if (copy < 0) fail("cannot watch a pseudo-terminal");
  return copy;
}

void Pty::release() {
  ::ioctl(slave_, TIOCNXCL);
}

}  // namespace laparoscope_servo::sim
