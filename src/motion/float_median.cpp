#include "motion/float_median.h"

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::motion {

namespace {

// An integer that is ordered as the floats are, and back: of a negative float all bits but the sign are turned over.
[[gnu::always_inline]] inline std::int32_t turned(std::int32_t bits) {
  return bits ^ ((bits >> 31) & INT32_MAX);
}

// Overwrites the values with integers in their order.
LAPAROSCOPE_SERVO_CLONES
void toOrder(float* values, int count) {
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    std::int32_t bits;
    std::memcpy(&bits, values + i, sizeof(bits));
    bits = turned(bits);
    std::memcpy(values + i, &bits, sizeof(bits));
  }
}

LAPAROSCOPE_SERVO_CLONES
int countUpTo(const float* values, int count, std::int32_t limit) {
  int found = 0;
#pragma omp simd reduction(+ : found)
  for (int i = 0; i < count; ++i) {
    std::int32_t bits;
    std::memcpy(&bits, values + i, sizeof(bits));
    found += static_cast<int>(bits <= limit);
  }
  return found;
}

}  // namespace

// The least integer up to which there are more than half of them, by bisection.
float floatMedian(std::vector<float>& values) {
  const int count = static_cast<int>(values.size());
  toOrder(values.data(), count);
  std::int64_t low = INT32_MIN, high = INT32_MAX;
  while (low < high) {
    const std::int64_t middle = low + (high - low) / 2;
    if (countUpTo(values.data(), count, static_cast<std::int32_t>(middle)) > count / 2) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  const std::int32_t bits = turned(static_cast<std::int32_t>(low));
  float median;
  std::memcpy(&median, &bits, sizeof(median));
  return median;
}

}  // namespace laparoscope_servo::motion
