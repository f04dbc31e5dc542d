// What a recording needs besides its messages: versions, parameters, and the files that these name.
#pragma once

#include <XmlRpcValue.h>

#include <string>

namespace laparoscope_servo {

// As YAML: versions, parameters, files. Of the parameters' texts that are names of small text files, the content is
// there, too: calibrations of camera and insertion point. What looks like a password is left out.
std::string sessionFacts(const XmlRpc::XmlRpcValue& parameters);

}  // namespace laparoscope_servo
