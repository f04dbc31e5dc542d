// What the recorder of a case says of itself in /diagnostics.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include <optional>
#include <string>

#include "screen/facts.h"

namespace laparoscope_servo::screen {

// `space`: the cart's namespace, as ros::NodeHandle gives it. Empty: the message is not of the recorder there.
std::optional<RecorderFacts> recorderIn(const diagnostic_msgs::DiagnosticArray& message, const std::string& space);

}  // namespace laparoscope_servo::screen
