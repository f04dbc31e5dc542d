#include "screen/minute_history.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::screen {

namespace {

std::int64_t numberOf(double now) {
  return static_cast<std::int64_t>(std::floor(std::max(0.0, now) / MinuteHistory::kStep));
}

}  // namespace

void MinuteHistory::Range::add(double value) {
  if (!std::isfinite(value)) return;
  low = known ? std::min(low, value) : value;
  high = known ? std::max(high, value) : value;
  known = true;
}

void MinuteHistory::add(double now, bool tracked, double confidence, double corner_error, double visible,
                        double delay) {
  const std::int64_t number = numberOf(now);
  Numbered& slot = ring_[static_cast<std::size_t>(number) % ring_.size()];
  if (slot.number != number) slot = {number, {}};
  Step& step = slot.step;
  step.ranges[kConfidence].add(confidence);
  step.ranges[kCornerError].add(corner_error);
  step.ranges[kVisible].add(visible);
  step.ranges[kDelay].add(delay);
  step.tracked = step.tracked && tracked;
  ++step.images;
}

std::vector<MinuteHistory::Step> MinuteHistory::steps(double now) const {
  std::vector<Step> steps;
  const std::int64_t last = numberOf(now);
  for (std::int64_t number = last - kSteps + 1; number <= last; ++number) {
    const Numbered* slot = number < 0 ? nullptr : &ring_[static_cast<std::size_t>(number) % ring_.size()];
    const bool known = slot != nullptr && slot->number == number;
    Step step = known ? slot->step : Step();
    if (number < last && (known || (!steps.empty() && steps.back().ranges[kRate].known))) {
      step.ranges[kRate].add(step.images / kStep);
    }
    steps.push_back(step);
  }
  return steps;
}

}  // namespace laparoscope_servo::screen
