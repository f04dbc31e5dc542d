// Real footage, which is no part of the project: ../shared/data beside the repository, or where LAPAROSCOPE_SERVO_DATA
// points. A test that needs it is skipped where it is not there.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace laparoscope_servo::test_support {

// Empty where there is no such file.
inline std::string footage(const std::string& name) {
  const char* set = std::getenv("LAPAROSCOPE_SERVO_DATA");
  const std::filesystem::path folder =
      set != nullptr && *set != '\0' ? std::filesystem::path(set) : std::filesystem::path(LAPAROSCOPE_SERVO_FOOTAGE);
  std::error_code error;
  return std::filesystem::exists(folder / name, error) ? (folder / name).string() : std::string();
}

}  // namespace laparoscope_servo::test_support
