#include "ros/controller/controller_parameters.h"

#include <algorithm>

#include "ros/common/frame_names.h"
#include "ros/common/parameter_names.h"

namespace laparoscope_servo {

using parameters::Table;

void describe(Table& table, ControllerNodeConfig& c) {
  table.number("rate", c.rate, {10, 200}, "Hz", "of the commands");
  table.number("diagnostic_period", c.diagnostic_period, {0.1, 60}, "s", "between two messages on /diagnostics");
  table.flag("rectified_images", c.rectified_images,
             "the images of motion, instruments and points are rectified: P of camera_info applies to them, otherwise "
             "K and D");
  describeFramePrefix(table, c.frame_prefix);
  table.group("frames", "names in tf", [&] {
    describeFrame(table, "insertion_point", c.insertion_point, "of the insertion point, O_A");
    describeFrame(table, "camera", c.camera, "of the camera, O_C: x right, y down, z forward");
    describeFrame(table, "shaft", c.shaft, "with z along the shaft, into the body; velocities are in its axes");
  });
  table.group("owners",
              "nodes whose messages are accepted; without a leading slash, in the namespace of this node; empty: the "
              "first publisher",
              [&] {
                describeOwner(table, "tf", c.tf_owner, "of the frames above");
                describeOwner(table, "task_error", c.owners.task_error,
                              "a tracker in a nodelet manager has the manager's name");
                describeOwner(table, "operating_state", c.owners.operating_state, "also of measured_cv");
                describeOwner(
                    table, "motion", c.owners.motion,
                    "of the motion of the view or of an object; in a nodelet manager it has the manager's name");
                describeOwner(table, "instrument", c.owners.instrument,
                              "of the tip; in a nodelet manager it has the manager's name");
                describeOwner(table, "points", c.owners.points,
                              "of the points; in a nodelet manager it has the manager's name");
                describeOwner(table, "camera_info", c.owners.camera_info, "of the camera of all of these");
                describeOwner(table, "manual", c.owners.manual, "of ~manual");
                describeOwner(table, "dead_man", c.owners.dead_man,
                              "whose true is accepted; false is accepted from every node");
              });
  describe(table, c.control);
  describe(table, c.external_stops);
}

std::vector<std::string> validate(const ControllerNodeConfig& config) {
  std::vector<std::string> errors = parameters::errorsOf(config);
  for (const std::string& error : servo::validate(config.control)) {
    if (std::find(errors.begin(), errors.end(), error) == errors.end()) errors.push_back(error);
  }
  return errors;
}

ControllerNodeConfig controllerNodeConfig(ParameterReader& reader) {
  ControllerNodeConfig config;
  reader.readAll(config);
  return config;
}

void resolveNames(ControllerNodeConfig& config, const ros::NodeHandle& node) {
  config.frame_prefix = framePrefix(config.frame_prefix, node.getNamespace());
  for (std::string* frame : {&config.insertion_point, &config.camera, &config.shaft}) {
    *frame = prefixedFrame(config.frame_prefix, *frame);
  }
  if (!config.tf_owner.empty()) config.tf_owner = node.resolveName(config.tf_owner, false);
}

}  // namespace laparoscope_servo
