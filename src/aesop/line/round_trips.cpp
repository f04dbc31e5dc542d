#include "laparoscope_servo/aesop/round_trips.h"

#include <cmath>

#include "laparoscope_servo/robust/median.h"

namespace laparoscope_servo::aesop {

void RoundTrips::add(double seconds) {
  if (times_.size() < capacity_) {
    times_.push_back(seconds);
    return;
  }
  times_[next_] = seconds;
  next_ = (next_ + 1) % capacity_;
}

void RoundTrips::clear() {
  times_.clear();
  next_ = 0;
}

RoundTripSummary RoundTrips::summary() const {
  RoundTripSummary summary;
  summary.count = times_.size();
  if (times_.empty()) return summary;
  for (std::size_t k = 1; k < times_.size(); ++k) {
    const std::size_t at = (next_ + k) % times_.size();
    const std::size_t before = (next_ + k - 1) % times_.size();
    summary.jitter += std::abs(times_[at] - times_[before]) / static_cast<double>(times_.size() - 1);
  }
  std::vector<double> times = times_;
  summary.median = robust::nearestRank(times, 0.5);
  summary.p99 = robust::nearestRank(times, 0.99);
  summary.longest = robust::nearestRank(times, 1.0);
  return summary;
}

}  // namespace laparoscope_servo::aesop
