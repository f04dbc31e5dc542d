// Names of tf frames in a namespace: two carts on one master have frames of their own without being told to.
#pragma once

#include <string>

namespace laparoscope_servo {

// The value of a parameter `frame_prefix` that leaves the prefix to the namespace.
constexpr const char* kPrefixOfNamespace = "auto";

// What stands in front of frames: `parameter` itself, or, when it is "auto", `name_space` as part of a frame's name:
// "/left" gives "left/", "/" gives "".
std::string framePrefix(const std::string& parameter, const std::string& name_space);

// `frame` with the prefix; one that has a slash in it is whole already.
std::string prefixedFrame(const std::string& prefix, const std::string& frame);

}  // namespace laparoscope_servo
