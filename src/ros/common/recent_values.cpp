#include "ros/common/recent_values.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace laparoscope_servo {

void RecentValues::add(double now, double value) {
  forget(now);
  if (entries_.size() == kMost) entries_.pop_front();
  entries_.push_back({now, value});
}

double RecentValues::percentile(double now, double share) {
  forget(now);
  if (entries_.empty()) return 0.0;
  std::vector<double> values(entries_.size());
  std::transform(entries_.begin(), entries_.end(), values.begin(), [](const Entry& entry) { return entry.value; });
  // The nearest rank.
  const double rank = std::ceil(share * static_cast<double>(values.size())) - 1.0;
  const auto at = static_cast<std::ptrdiff_t>(std::clamp(rank, 0.0, static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

double RecentValues::sum(double now) {
  forget(now);
  return std::accumulate(entries_.begin(), entries_.end(), 0.0,
                         [](double sum, const Entry& entry) { return sum + entry.value; });
}

std::size_t RecentValues::count(double now) {
  forget(now);
  return entries_.size();
}

void RecentValues::forget(double now) {
  while (!entries_.empty() && now - entries_.front().time > span_) entries_.pop_front();
}

}  // namespace laparoscope_servo
