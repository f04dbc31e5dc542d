// Rows for parameters that are ROS names: nodes, tf frames.
#pragma once

#include <string>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo {

// A row whose text must be the name of a tf frame, without a leading slash.
parameters::Row& describeFrame(parameters::Table& table, const std::string& name, std::string& frame,
                               const std::string& meaning);
// A row `frame_prefix`, see frame_names.h.
parameters::Row& describeFramePrefix(parameters::Table& table, std::string& prefix);
// A row whose text must be the name of a node, or empty.
parameters::Row& describeOwner(parameters::Table& table, const std::string& name, std::string& node,
                               const std::string& meaning);

constexpr const char* kNodeName = "the name of a node, e.g. controller or /controller";
bool isNodeName(const std::string& name);

}  // namespace laparoscope_servo
