#pragma once

#include <algorithm>
#include <cstddef>

namespace laparoscope_servo::robust {

// Of an even number, the upper of the two in the middle. Reorders `values`, of which there is at least one, none NaN.
template <typename Values>
typename Values::value_type median(Values& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace laparoscope_servo::robust
