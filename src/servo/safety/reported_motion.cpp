#include "servo/safety/reported_motion.h"

#include <algorithm>

namespace laparoscope_servo::servo {

void ReportedMotion::add(double time, const scope::Velocity& velocity) {
  if (!reports_.empty() && time < reports_.back().time) reports_.clear();
  reports_.push_back({time, velocity.vector()});
  // Keeps the report that was valid at the start of the span.
  while (reports_.size() > 1 && reports_[1].time <= time - span_) reports_.pop_front();
}

Eigen::Vector4d ReportedMotion::displacement(double begin, double end) const {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (std::size_t k = 0; k < reports_.size(); ++k) {
    const Report& report = reports_[k];
    const Report* next = k + 1 < reports_.size() ? &reports_[k + 1] : nullptr;
    const bool goes_on = next != nullptr && next->time - report.time <= life_;
    const double from = std::max(begin, report.time), to = std::min(end, goes_on ? next->time : report.time + life_);
    if (!(to > from)) continue;
    Eigen::Vector4d mean = report.velocity;
    if (goes_on) {
      const double share = (0.5 * (from + to) - report.time) / (next->time - report.time);
      mean += share * (next->velocity - report.velocity);
    }
    sum += (to - from) * mean;
  }
  return sum;
}

}  // namespace laparoscope_servo::servo
