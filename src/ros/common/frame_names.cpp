#include "ros/common/frame_names.h"

namespace laparoscope_servo {

std::string framePrefix(const std::string& parameter, const std::string& name_space) {
  if (parameter != kPrefixOfNamespace) return parameter;
  const std::size_t first = name_space.find_first_not_of('/');
  if (first == std::string::npos) return "";
  const std::size_t last = name_space.find_last_not_of('/');
  return name_space.substr(first, last - first + 1) + "/";
}

std::string prefixedFrame(const std::string& prefix, const std::string& frame) {
  return frame.find('/') == std::string::npos ? prefix + frame : frame;
}

}  // namespace laparoscope_servo
