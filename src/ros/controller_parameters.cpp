#include "laparoscope_servo/ros/controller_parameters.h"

#include <limits>

namespace laparoscope_servo::skin {

namespace {

// The range is servo::validate's to judge.
void readNumber(ParameterReader& reader, const std::string& path, double& value) {
  reader.read(path, value, -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity());
}

void readVelocity(ParameterReader& reader, const std::string& group, servo::ScopeVelocity& value) {
  readNumber(reader, group + "/pan", value.pan);
  readNumber(reader, group + "/tilt", value.tilt);
  readNumber(reader, group + "/spin", value.spin);
  readNumber(reader, group + "/insertion", value.insertion);
}

void readSafety(ParameterReader& reader, servo::SafetyConfig& safety) {
  readNumber(reader, "safety/max_task_error_age", safety.max_task_error_age);
  readNumber(reader, "safety/max_depth_age", safety.max_depth_age);
  readNumber(reader, "safety/min_depth", safety.min_depth);
  readNumber(reader, "safety/max_depth", safety.max_depth);
  readNumber(reader, "safety/max_lateral_offset", safety.max_lateral_offset);
  readNumber(reader, "safety/resume_time", safety.resume_time);
  readNumber(reader, "safety/max_period", safety.max_period);
  readNumber(reader, "safety/max_clock_step", safety.max_clock_step);
  readNumber(reader, "safety/slow_below", safety.slow_below);
  readNumber(reader, "safety/hold_below", safety.hold_below);
  readNumber(reader, "safety/release_hold_above", safety.release_hold_above);
  readNumber(reader, "safety/min_visible_for_insertion", safety.min_visible_for_insertion);
  readNumber(reader, "safety/max_corner_error_for_insertion", safety.max_corner_error_for_insertion);
  reader.read("safety/dead_man_required", safety.dead_man_required);
  readNumber(reader, "safety/max_dead_man_age", safety.max_dead_man_age);
  reader.read("safety/robot_required", safety.robot_required);
  readNumber(reader, "safety/max_robot_state_age", safety.max_robot_state_age);
}

void readFrame(ParameterReader& reader, const std::string& path, std::string& frame) {
  reader.read(path, frame);
  if (frame.empty() || frame.front() == '/') {
    reader.addError(path + " = '" + frame + "', expected the name of a tf frame, without a leading slash");
  }
}

}  // namespace

servo::ControllerConfig controllerConfig(ParameterReader& reader) {
  servo::ControllerConfig config;
  readNumber(reader, "gains/pan", config.gains.pan);
  readNumber(reader, "gains/tilt", config.gains.tilt);
  readNumber(reader, "gains/spin", config.gains.spin);
  readNumber(reader, "gains/insertion", config.gains.insertion);
  reader.read("dead_zone/inverse", config.dead_zone.inverse);
  readVelocity(reader, "dead_zone/width", config.dead_zone.width);
  readVelocity(reader, "dead_zone/stop", config.dead_zone.stop);
  readVelocity(reader, "dead_zone/start", config.dead_zone.start);
  readVelocity(reader, "limits/velocity", config.limits.velocity);
  readVelocity(reader, "limits/acceleration", config.limits.acceleration);
  readSafety(reader, config.safety);
  reader.addErrors(servo::validate(config));
  return config;
}

ControllerNodeConfig controllerNodeConfig(ParameterReader& reader) {
  ControllerNodeConfig config;
  reader.read("rate", config.rate, 10.0, 200.0);
  readFrame(reader, "frames/insertion_point", config.insertion_point);
  readFrame(reader, "frames/camera", config.camera);
  config.control = controllerConfig(reader);
  double diagnostic_period = 1.0;  // read again by diagnostic_updater
  reader.read("diagnostic_period", diagnostic_period, 0.1, 60.0);
  reader.refuseUnknown("");
  return config;
}

}  // namespace laparoscope_servo::skin
