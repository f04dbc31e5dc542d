// Facts of a session that a recording needs besides its messages: versions, parameters, and the files named by these.
#pragma once

#include <XmlRpcValue.h>

#include <string>

namespace laparoscope_servo {

// YAML with versions, parameters and files. Includes the contents of small text files that are named by parameters:
// calibrations of camera and insertion point. Omits values that look like passwords.
std::string sessionFacts(const XmlRpc::XmlRpcValue& parameters);

}  // namespace laparoscope_servo
