// Median and quantiles.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace laparoscope_servo::robust {

// Median; the upper of the two middle values for an even number. Reorders `values`, which must not be empty nor hold a
// NaN.
template <typename Values>
typename Values::value_type median(Values& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Quantile by nearest rank: the smallest value that at least the share `share` (0 to 1) of the values do not exceed.
// For an even number, that of 0.5 is the lower of the two middle values. Reorders `values`, which must not be empty nor
// hold a NaN.
template <typename Values>
typename Values::value_type nearestRank(Values& values, double share) {
  const auto last = static_cast<double>(values.size() - 1);
  const double rank = std::clamp(std::ceil(share * static_cast<double>(values.size())) - 1.0, 0.0, last);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace laparoscope_servo::robust
