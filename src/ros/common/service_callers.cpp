#include "ros/common/service_callers.h"

#include <algorithm>

#include "ros/common/input_owner.h"

namespace laparoscope_servo {

std::string ServiceCallers::refusal(const std::string& service, const std::string& caller) const {
  if (names_.empty() || std::find(names_.begin(), names_.end(), caller) != names_.end()) return "";
  return service + " is refused to " + shownName(caller) + ": the parameter service_callers does not name it";
}

}  // namespace laparoscope_servo
