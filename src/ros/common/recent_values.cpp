#include "ros/common/recent_values.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "laparoscope_servo/robust/median.h"

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
  return robust::nearestRank(values, share);
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
