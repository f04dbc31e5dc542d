// Times from a request to its reply, of the last few seconds.
#pragma once

#include <cstddef>
#include <vector>

namespace laparoscope_servo::aesop {

struct RoundTripSummary {
  std::size_t count = 0;  // number of round trips; all members are zero if there are none
  double median = 0.0;    // s
  double p99 = 0.0;       // s, 99 of 100 are not longer
  double longest = 0.0;   // s
  double jitter = 0.0;    // s, mean difference between one and the next
};

class RoundTrips {
 public:
  // 400: ten seconds at 40 Hz.
  explicit RoundTrips(std::size_t capacity = 400) : capacity_(capacity) {}

  void add(double seconds);
  void clear();
  RoundTripSummary summary() const;

 private:
  std::size_t capacity_;
  std::vector<double> times_;  // ring buffer
  std::size_t next_ = 0;
};

}  // namespace laparoscope_servo::aesop
