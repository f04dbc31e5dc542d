// A line beside ROS that stops the arm: a contact read through a GPIO pin, any file, or a modem line of a serial port.
//
// A thread of its own reads it at a steady rate, for a reading may block. Whoever controls something asks obstacle(),
// which never does. Everything that is not clearly the level of a closed contact stops: a file that is missing, empty
// or unreadable, another character, a reading that takes too long.
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
  std::string path;       // of the file or the serial port; empty: there is no line
  std::string signal;     // CTS, DSR or CD of a serial port; empty: the first character of a file, 0 or 1
  int release = 1;        // the level, 0 or 1, at which the arm may move
  double rate = 100.0;    // Hz
  double patience = 0.3;  // s: without a reading for so long the arm stops
};

void describe(parameters::Table& table, StopLineConfig& config);
std::vector<std::string> validate(const StopLineConfig& config);

// One reading: why the arm must stop, or nothing. `file` is the descriptor of a serial port, kept from one reading to
// the next, -1 while it is closed.
std::string readStopLine(const StopLineConfig& config, int& file);

class StopLine {
 public:
  using Read = std::function<std::string()>;

  // Reads by readStopLine().
  explicit StopLine(const StopLineConfig& config);
  // `read`: in place of it; may block for ever.
  StopLine(const StopLineConfig& config, const Read& read);
  ~StopLine();
  StopLine(const StopLine&) = delete;
  StopLine& operator=(const StopLine&) = delete;

  bool isThere() const { return shared_ != nullptr; }
  // Why the arm may not move, `now` in s, steady; empty: nothing stops it.
  std::string obstacle(double now) const;
  // Readings that said stop after one that did not, and the words of the latest: a short pulse counts, too.
  std::uint64_t stops() const;
  std::string lastStop() const;

 private:
  struct Shared;
  void start(const Read& read);

  StopLineConfig config_;
  std::shared_ptr<Shared> shared_;  // with the thread, which may outlive this object while it is blocked
};

}  // namespace laparoscope_servo
