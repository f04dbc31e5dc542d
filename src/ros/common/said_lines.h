// Which lines reach the screen, of something that may change as often as it likes: each new one does, unless there are
// so many that nobody could read them; then the one that lasts does, and the number of those that did not.
//
// Pure: `now` is s of a steady clock.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace laparoscope_servo {

class SaidLines {
 public:
  // The same line is said again after `repeat` s; by default never.
  explicit SaidLines(double repeat = std::numeric_limits<double>::infinity()) : repeat_(repeat) {}

  // The line to say now, if any. `text`: what holds now; call it again as long as it does.
  std::optional<std::string> take(const std::string& text, double now);

 private:
  double repeat_;
  std::string said_;  // the last one
  bool any_ = false;
  double said_at_ = 0.0;                                         // s
  double allowance_ = 0.0;                                       // lines
  double filled_at_ = -std::numeric_limits<double>::infinity();  // s
  std::string missed_;                                           // the last that was not said
  std::uint64_t missing_ = 0;                                    // lines
};

}  // namespace laparoscope_servo
