// The emulator's fault script, from YAML: doc/aesop_emulator.md describes it.
#pragma once

#include <XmlRpcValue.h>

#include <string>
#include <vector>

#include "laparoscope_servo/sim/faults.h"

namespace laparoscope_servo {

// `tree`: a struct with the one member `script`, a list of entries. Errors name the entry, counted from 1; with any,
// what is returned is of no use.
std::vector<sim::ScheduledFault> readScript(const XmlRpc::XmlRpcValue& tree, std::vector<std::string>& errors);

// The same from a file. Throws std::runtime_error with all errors, naming the file.
std::vector<sim::ScheduledFault> scriptFromYaml(const std::string& file);

}  // namespace laparoscope_servo
