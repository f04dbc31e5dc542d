#include "laparoscope_servo/aesop/round_trips.h"

#include <algorithm>
#include <cmath>

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
  std::vector<double> sorted = times_;
  std::sort(sorted.begin(), sorted.end());
  const auto rank = [&](double share) {
    return sorted[static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size()))) - 1];
  };
  summary.median = rank(0.5);
  summary.p99 = rank(0.99);
  summary.longest = sorted.back();
  return summary;
}

}  // namespace laparoscope_servo::aesop
