// A line beside ROS that stops the arm: a contact read through a GPIO pin, any file, or a modem line of a serial port.
//
// A separate thread reads it at a steady rate, since a reading may block; obstacle() never blocks. Everything but the
// clear level of a closed contact is a stop: a file that is missing, empty or unreadable, another character, a reading
// that takes too long.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo {

// Defaults are those of config/aesop.yaml and config/controller.yaml, group `stop_line`.
struct StopLineConfig {
  std::string path;       // path of the file or serial port; empty: there is no line
  std::string signal;     // CTS, DSR or CD of a serial port; empty: the first character of a file, 0 or 1
  int release = 1;        // the level, 0 or 1, at which the arm may move
  double rate = 100.0;    // Hz
  double patience = 0.3;  // s: longest time without a reading, after which the arm stops
};

void describe(parameters::Table& table, StopLineConfig& config);
std::vector<std::string> validate(const StopLineConfig& config);

// Does one reading; returns why the arm must stop, or an empty text. `file` is the descriptor of a serial port, kept
// from one reading to the next, -1 while it is closed.
std::string readStopLine(const StopLineConfig& config, int& file);

class StopLine {
 public:
  using Read = std::function<std::string()>;

  // Reads by readStopLine().
  explicit StopLine(const StopLineConfig& config);
  // `read`: used instead of readStopLine(); may block for ever.
  StopLine(const StopLineConfig& config, const Read& read);
  ~StopLine();
  StopLine(const StopLine&) = delete;
  StopLine& operator=(const StopLine&) = delete;

  bool isThere() const { return shared_ != nullptr; }
  // Why the arm may not move; empty: it may. `now`: s, steady.
  std::string obstacle(double now) const;
  // Number of changes to stop, and the reason of the latest; short pulses count too.
  std::uint64_t stops() const;
  std::string lastStop() const;

 private:
  struct Shared;
  void start(const Read& read);

  StopLineConfig config_;
  std::shared_ptr<Shared> shared_;  // shared with the thread, which may outlive this object while it is blocked
};

}  // namespace laparoscope_servo
