// Orders names by the numbers in them.
#pragma once

#include <string>

namespace laparoscope_servo {

// frame2 before frame10. For equal numbers, the one with fewer leading zeros comes first; otherwise byte by byte.
bool comesBefore(const std::string& left, const std::string& right);

}  // namespace laparoscope_servo
