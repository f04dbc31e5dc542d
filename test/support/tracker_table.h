// Lines of the table that the offline tool writes.
#pragma once

#include <cstddef>
#include <string>

namespace laparoscope_servo::test_support {

// All but processing_time, which differs from run to run.
inline std::string withoutTime(const std::string& line) {
  constexpr int kProcessingTime = 15;
  std::size_t begin = 0;
  for (int column = 0; column < kProcessingTime; ++column) begin = line.find(',', begin) + 1;
  return line.substr(0, begin) + line.substr(line.find(',', begin));
}

}  // namespace laparoscope_servo::test_support
