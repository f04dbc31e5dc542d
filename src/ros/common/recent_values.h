// The values of the last minute, for percentiles.
#pragma once

#include <cstddef>
#include <deque>

namespace laparoscope_servo {

// Times are seconds of any steady clock.
class RecentValues {
 public:
  explicit RecentValues(double span = 60.0) : span_(span) {}

  void add(double now, double value);
  // Statistics of the values that are not older than the span; both 0 if there are none. `share`: 0 to 1; for 0.95 the
  // value that 95 % of them do not exceed.
  double percentile(double now, double share);
  double sum(double now);
  std::size_t count(double now);

 private:
  struct Entry {
    double time;
    double value;
  };
  void forget(double now);

  static constexpr std::size_t kMost = 20000;  // a minute at 333 Hz
  double span_;
  std::deque<Entry> entries_;
};

}  // namespace laparoscope_servo
