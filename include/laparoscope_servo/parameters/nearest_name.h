#pragma once

#include <set>
#include <string>

namespace laparoscope_servo::parameters {

// Which of the known names somebody meant who wrote `path`: one that is a slip or two of the finger away, or the same
// name in another group. Empty when there is none.
std::string nearestName(const std::set<std::string>& known, const std::string& path);

}  // namespace laparoscope_servo::parameters
