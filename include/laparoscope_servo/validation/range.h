// Ranges of numbers, and their form in texts: [0, 1] with its ends, (0, 1] without 0.
#pragma once

#include <limits>
#include <string>

namespace laparoscope_servo::validation {

struct Range {
  // [low, high]
  constexpr Range(double low_end, double high_end) : low(low_end), high(high_end) {}
  // (low, high]
  static constexpr Range above(double low, double high) { return {low, high, false, true}; }
  // (low, high)
  static constexpr Range between(double low, double high) { return {low, high, false, false}; }
  // All finite numbers.
  static constexpr Range finite() {
    return between(-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity());
  }

  // NaN is in no range.
  constexpr bool contains(double value) const {
    return (with_low ? value >= low : value > low) && (with_high ? value <= high : value < high);
  }
  // "[0, 1]"
  std::string text() const;

  double low;
  double high;
  bool with_low = true;
  bool with_high = true;

 private:
  constexpr Range(double low_end, double high_end, bool low_too, bool high_too)
      : low(low_end), high(high_end), with_low(low_too), with_high(high_too) {}
};

// The number with the fewest digits that read back as the same number.
std::string numberText(double value);

}  // namespace laparoscope_servo::validation
