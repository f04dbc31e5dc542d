// Means and quantiles of measured values.
#pragma once

#include <vector>

namespace laparoscope_servo::bench {

// NaN for no values.
double mean(const std::vector<double>& values);
// q in [0, 1], linear between neighbours; NaN for no values.
double quantile(std::vector<double> values, double q);

}  // namespace laparoscope_servo::bench
