// Limits the lines on the terminal about a text that may change often: each new text is printed, unless there are too
// many to read; then only a text that lasts is, with the number of those left out.
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
  // An unchanged text is printed again after `repeat` s; by default never.
  explicit SaidLines(double repeat = std::numeric_limits<double>::infinity()) : repeat_(repeat) {}

  // The line to print now, if any. `text`: the present one; call regularly.
  std::optional<std::string> take(const std::string& text, double now);

 private:
  double repeat_;
  std::string said_;  // the last text printed
  bool any_ = false;
  double said_at_ = 0.0;                                         // s
  double allowance_ = 0.0;                                       // lines
  double filled_at_ = -std::numeric_limits<double>::infinity();  // s
  std::string missed_;                                           // the last text that was not printed
  std::uint64_t missing_ = 0;                                    // lines
};

}  // namespace laparoscope_servo
