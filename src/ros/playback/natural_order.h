// Names with numbers in them in the order of the numbers.
#pragma once

#include <string>

namespace laparoscope_servo {

// frame2 before frame10. Of equal numbers the one with fewer zeros in front comes first; otherwise byte by byte.
bool comesBefore(const std::string& left, const std::string& right);

}  // namespace laparoscope_servo
