#include "ros/common/parameter_names.h"

#include <ros/names.h>

namespace laparoscope_servo {

parameters::Row& describeFrame(parameters::Table& table, const std::string& name, std::string& frame,
                               const std::string& meaning) {
  return table.text(name, frame, meaning)
      .accepting("the name of a tf frame, without a leading slash",
                 [](const std::string& text) { return !text.empty() && text[0] != '/'; });
}

parameters::Row& describeFramePrefix(parameters::Table& table, std::string& prefix) {
  return table.text(
      "frame_prefix", prefix,
      "text in front of the names of frames that have no slash; auto: the namespace, left/ in /left, nothing in "
      "the root");
}

parameters::Row& describeOwner(parameters::Table& table, const std::string& name, std::string& node,
                               const std::string& meaning) {
  return table.text(name, node, meaning)
      .accepting("the name of a node, e.g. tracker or /tracker, or nothing",
                 [](const std::string& text) { return text.empty() || isNodeName(text); });
}

bool isNodeName(const std::string& name) {
  std::string why;
  return !name.empty() && name[0] != '~' && ros::names::validate(name, why);
}

}  // namespace laparoscope_servo
