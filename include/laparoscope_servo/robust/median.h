// The middle of values, and what a share of them does not exceed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace laparoscope_servo::robust {

// Of an even number, the upper of the two in the middle. Reorders `values`, of which there is at least one, none NaN.
template <typename Values>
typename Values::value_type median(Values& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The nearest rank: the smallest of the values that at least `share` (0 to 1) of them do not exceed. Of an even number,
// that of 0.5 is the lower of the two in the middle. Reorders `values`, of which there is at least one, none NaN.
template <typename Values>
typename Values::value_type nearestRank(Values& values, double share) {
  const auto last = static_cast<double>(values.size() - 1);
  const double rank = std::clamp(std::ceil(share * static_cast<double>(values.size())) - 1.0, 0.0, last);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace laparoscope_servo::robust
