#include "ros/common/stop_line.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <mutex>
#include <sstream>
#include <thread>

#include "ros/common/clocks.h"
#include "ros/common/quiet_thread.h"

namespace laparoscope_servo {

namespace {

// The modem line's bit of TIOCMGET; 0 when there is no such line.
int modemBit(const std::string& signal) {
  if (signal == "CTS") return TIOCM_CTS;
  if (signal == "DSR") return TIOCM_DSR;
  if (signal == "CD") return TIOCM_CD;
  return 0;
}

std::string judge(const StopLineConfig& config, bool level) {
  if (level == (config.release == 1)) return "";
  return "the stop line " + config.path + (config.signal.empty() ? "" : ", " + config.signal) + ", says stop";
}

std::string unreadable(const StopLineConfig& config, const std::string& why) {
  return "the stop line " + config.path + (config.signal.empty() ? "" : ", " + config.signal) +
         ", cannot be read: " + why;
}

// Opened anew each time, so that a replaced or deleted file is noticed.
std::string readFile(const StopLineConfig& config) {
  const int file = ::open(config.path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (file < 0) return unreadable(config, std::strerror(errno));
  char first = '\0';
  const ssize_t count = ::read(file, &first, 1);
  const int error = errno;
  ::close(file);
  if (count < 0) return unreadable(config, std::strerror(error));
  if (count == 0) return unreadable(config, "it is empty");
  if (first != '0' && first != '1') return unreadable(config, "it begins neither with 0 nor with 1");
  return judge(config, first == '1');
}

std::string readModemLine(const StopLineConfig& config, int& file) {
  if (file < 0) file = ::open(config.path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (file < 0) return unreadable(config, std::strerror(errno));
  int lines = 0;
  if (::ioctl(file, TIOCMGET, &lines) == 0) return judge(config, (lines & modemBit(config.signal)) != 0);
  const int error = errno;
  ::close(file);
  file = -1;
  return unreadable(config, std::strerror(error));
}

}  // namespace

void describe(parameters::Table& table, StopLineConfig& c) {
  table.text("path", c.path, "of a GPIO's value, any file, or a serial port; empty: none");
  table.choice("signal", c.signal, {"", "CTS", "DSR", "CD"},
               "of a serial port; empty: the file's first character, 0 or 1");
  table.number("release", c.release, {0, 1}, "level", "at which the arm may move; anything else stops it");
  table.number("rate", c.rate, {10, 1000}, "Hz", "at which it is read");
  table.number("patience", c.patience, {0.05, 5}, "s", "longest time without a reading; then the arm stops");
}

std::vector<std::string> validate(const StopLineConfig& config) {
  return parameters::errorsOf(config);
}

std::string readStopLine(const StopLineConfig& config, int& file) {
  return config.signal.empty() ? readFile(config) : readModemLine(config, file);
}

struct StopLine::Shared {
  std::atomic<bool> ending{false};
  std::mutex mutex;  // never held during a reading
  std::string obstacle;
  std::string last_stop;
  std::uint64_t stops = 0;
  double read_at = 0.0;  // s, steady; 0: never
};

StopLine::StopLine(const StopLineConfig& config) : config_(config) {
  if (config.path.empty()) return;
  const auto file = std::shared_ptr<int>(new int(-1), [](const int* open) {
    if (*open >= 0) ::close(*open);
    delete open;
  });
  start([config, file] { return readStopLine(config, *file); });
}

StopLine::StopLine(const StopLineConfig& config, const Read& read) : config_(config) {
  start(read);
}

void StopLine::start(const Read& read) {
  shared_ = std::make_shared<Shared>();
  const auto period = std::chrono::duration<double>(1.0 / config_.rate);
  startQuietThread([shared = shared_, read, period] {
    bool stopped = false;
    while (!shared->ending) {
      const std::string obstacle = read();
      {
        const std::lock_guard<std::mutex> lock(shared->mutex);
        if (!obstacle.empty() && !stopped) {
          ++shared->stops;
          shared->last_stop = obstacle;
        }
        stopped = !obstacle.empty();
        shared->obstacle = obstacle;
        shared->read_at = steadyNow();
      }
      std::this_thread::sleep_for(period);
    }
  }).detach();
}

StopLine::~StopLine() {
  if (shared_) shared_->ending = true;
}

std::string StopLine::obstacle(double now) const {
  if (!shared_) return "";
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  if (shared_->read_at == 0.0) return unreadable(config_, "it has not been read yet");
  if (now - shared_->read_at > config_.patience) {
    std::ostringstream why;
    why << "no reading for " << config_.patience << " s";
    return unreadable(config_, why.str());
  }
  return shared_->obstacle;
}

std::uint64_t StopLine::stops() const {
  if (!shared_) return 0;
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  return shared_->stops;
}

std::string StopLine::lastStop() const {
  if (!shared_) return "";
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  return shared_->last_stop;
}

}  // namespace laparoscope_servo
