// The median of many floats.
#pragma once

#include <vector>

namespace laparoscope_servo::motion {

// As robust::median(), but without a branch for each value, and for floats alone: a fraction of its time. `values` must
// not be empty nor hold a NaN; it is overwritten.
float floatMedian(std::vector<float>& values);

}  // namespace laparoscope_servo::motion
