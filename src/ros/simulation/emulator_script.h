// The emulator's fault script, from YAML: doc/aesop_emulator.md describes it.
#pragma once

#include <XmlRpcValue.h>

#include <string>
#include <vector>

#include "laparoscope_servo/sim/faults.h"

namespace laparoscope_servo {

// `tree`: a struct with the single member `script`, a list of entries. Errors name the entry, counted from 1; the
// result is valid only without errors.
std::vector<sim::ScheduledFault> readScript(const XmlRpc::XmlRpcValue& tree, std::vector<std::string>& errors);

// Reads the script from a file. Throws std::runtime_error with the file's name and all errors.
std::vector<sim::ScheduledFault> scriptFromYaml(const std::string& file);

}  // namespace laparoscope_servo
