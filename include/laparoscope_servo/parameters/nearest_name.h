#pragma once

#include <set>
#include <string>

namespace laparoscope_servo::parameters {

// The known name that was probably meant by `path`: one with one or two typing errors, or the same name in another
// group. Empty if there is none.
std::string nearestName(const std::set<std::string>& known, const std::string& path);

}  // namespace laparoscope_servo::parameters
