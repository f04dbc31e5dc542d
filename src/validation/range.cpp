#include "laparoscope_servo/validation/range.h"

#include <cstdio>
#include <cstdlib>

namespace laparoscope_servo::validation {

std::string Range::text() const {
  return (with_low ? "[" : "(") + numberText(low) + ", " + numberText(high) + (with_high ? "]" : ")");
}

std::string numberText(double value) {
  constexpr int kFewest = 6;   // below it printf writes 10000 as 1e+04
  constexpr int kEnough = 17;  // for every double
  char text[32];
  for (int digits = kFewest; digits <= kEnough; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  return text;
}

}  // namespace laparoscope_servo::validation
