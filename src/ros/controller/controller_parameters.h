// Parameters of the controller node.
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "laparoscope_servo/servo/controller_config.h"
#include "ros/common/external_stops.h"
#include "ros/common/parameters.h"

namespace laparoscope_servo {

// Owners of the input topics, by node name: relative to the controller's namespace, or with a leading slash. Empty: the
// first publisher.
struct InputOwners {
  std::string task_error = "tracker";
  std::string operating_state = "aesop";  // also owns measured_cv
  std::string motion = "motion";
  std::string instrument = "instrument";
  std::string points = "points";
  std::string camera_info;
  std::string manual;
  std::string dead_man;
};

struct ControllerNodeConfig {
  double rate = 50.0;                               // Hz, of the commands
  double diagnostic_period = 1.0;                   // s, also read by diagnostic_updater
  std::string insertion_point = "insertion_point";  // tf frame, O_A
  std::string camera = "laparoscope_optical";       // tf frame, O_C
  std::string shaft = "scope_tip";                  // tf frame with its z axis along the shaft, into the body
  InputOwners owners;
  bool rectified_images = false;      // P of camera_info applies to the features' pixels, otherwise K
  std::string frame_prefix = "auto";  // prefix of frames without a slash; auto: the namespace
  std::string tf_owner = "aesop";     // the node that publishes these frames; empty: the first publisher
  servo::ControllerConfig control;
  ExternalStopsConfig external_stops;
};

// Adds the rows of all parameters of the node.
void describe(parameters::Table& table, ControllerNodeConfig& config);
std::vector<std::string> validate(const ControllerNodeConfig& config);

// Reads the parameters that are set; the others keep their defaults. Errors, also those of servo::validate, go to the
// reader.
ControllerNodeConfig controllerNodeConfig(ParameterReader& reader);

// Completes the names of frames and nodes, which depend on the node's namespace.
void resolveNames(ControllerNodeConfig& config, const ros::NodeHandle& node);

}  // namespace laparoscope_servo
