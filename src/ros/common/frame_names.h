// Names of tf frames by namespace, so that two carts on one master have different frames by default.
#pragma once

#include <string>

namespace laparoscope_servo {

// The value of a parameter `frame_prefix` that leaves the prefix to the namespace.
constexpr const char* kPrefixOfNamespace = "auto";

// The prefix of frames: `parameter`, or, if that is "auto", one from `name_space`: "/left" gives "left/", "/" gives "".
std::string framePrefix(const std::string& parameter, const std::string& name_space);

// `frame` with the prefix; a name with a slash is returned unchanged.
std::string prefixedFrame(const std::string& prefix, const std::string& frame);

}  // namespace laparoscope_servo
