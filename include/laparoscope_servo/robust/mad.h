// The robust scale of residuals: the median absolute deviation.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "laparoscope_servo/robust/median.h"
#include "laparoscope_servo/robust/scale.h"

namespace laparoscope_servo::robust {

struct Spread {
  double centre = 0.0;  // Med(Delta)
  double sigma = 0.0;   // 1.4826 Med|Delta - Med(Delta)|, eq. (13): the standard deviation, of normal noise
};

// Of at least one value, none NaN. Up to half of them may be anything. Overwrites `values`.
template <typename Values>
Spread spread(Values& values) {
  Spread result;
  result.centre = static_cast<double>(median(values));
  using Value = typename Values::value_type;
  const Value centre = static_cast<Value>(result.centre);
  for (Value& value : values) value = std::abs(value - centre);
  result.sigma = kMadToSigma * static_cast<double>(median(values));
  return result;
}

}  // namespace laparoscope_servo::robust
