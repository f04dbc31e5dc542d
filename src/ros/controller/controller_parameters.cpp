#include "ros/controller/controller_parameters.h"

#include <ros/names.h>

#include <limits>

#include "ros/common/frame_names.h"

namespace laparoscope_servo {

namespace {

// The range is servo::validate's to judge.
void readNumber(ParameterReader& reader, const std::string& path, double& value) {
  reader.read(path, value, -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity());
}

void readVelocity(ParameterReader& reader, const std::string& group, scope::Velocity& value) {
  readNumber(reader, group + "/pan", value.pan);
  readNumber(reader, group + "/tilt", value.tilt);
  readNumber(reader, group + "/spin", value.spin);
  readNumber(reader, group + "/insertion", value.insertion);
}

void readLaw(ParameterReader& reader, servo::ControllerConfig& config) {
  std::string law = "features", spin = "servo";
  reader.read("law", law, {"features", "paper"});
  config.law = law == "paper" ? servo::LawKind::kPaper : servo::LawKind::kFeatures;
  reader.read("spin", spin, {"servo", "upright", "released"});
  config.spin = spin == "released"  ? servo::SpinMode::kReleased
                : spin == "upright" ? servo::SpinMode::kUpright
                                    : servo::SpinMode::kServo;
  readNumber(reader, "gains/pan", config.gains.pan);
  readNumber(reader, "gains/tilt", config.gains.tilt);
  readNumber(reader, "gains/spin", config.gains.spin);
  readNumber(reader, "gains/insertion", config.gains.insertion);
  readNumber(reader, "features/centre", config.features.centre);
  readNumber(reader, "features/depth", config.features.depth);
  readNumber(reader, "features/orientation", config.features.orientation);
  readNumber(reader, "features/desired_depth", config.features.desired_depth);
}

void readTarget(ParameterReader& reader, servo::ControllerConfig& config) {
  reader.read("predictor/enabled", config.predictor.enabled);
  readNumber(reader, "predictor/delay", config.predictor.delay);
  reader.read("predictor/measure_delay", config.predictor.measure_delay);
  readNumber(reader, "predictor/min_delay", config.predictor.min_delay);
  readNumber(reader, "predictor/max_delay", config.predictor.max_delay);
  reader.read("predictor/feed_forward", config.predictor.feed_forward);
  readNumber(reader, "predictor/command_lifetime", config.predictor.command_lifetime);
  reader.read("breathing/enabled", config.breathing.enabled);
  readNumber(reader, "breathing/rate", config.breathing.rate);
  readNumber(reader, "breathing/rate_stddev", config.breathing.rate_stddev);
  readNumber(reader, "breathing/min_rate", config.breathing.filter.min_frequency);
  readNumber(reader, "breathing/max_rate", config.breathing.filter.max_frequency);
  readNumber(reader, "target/centre_noise", config.target.centre_noise);
  readNumber(reader, "target/depth_noise", config.target.depth_noise);
  readNumber(reader, "target/orientation_noise", config.target.orientation_noise);
  readNumber(reader, "target/centre_wander", config.target.centre_wander);
  readNumber(reader, "target/depth_wander", config.target.depth_wander);
  readNumber(reader, "target/orientation_wander", config.target.orientation_wander);
  readNumber(reader, "target/centre_acceleration", config.target.centre_acceleration);
  readNumber(reader, "target/depth_acceleration", config.target.depth_acceleration);
  readNumber(reader, "target/orientation_acceleration", config.target.orientation_acceleration);
  readNumber(reader, "target/calibration", config.target.calibration);
  readNumber(reader, "target/significance", config.target.significance);
  readNumber(reader, "target/jump", config.target.jump);
  readNumber(reader, "target/damping", config.target.damping);
}

void readEffect(ParameterReader& reader, servo::EffectConfig& effect) {
  reader.read("effect/enabled", effect.enabled);
  readNumber(reader, "effect/tissue_centre", effect.tissue_centre);
  readNumber(reader, "effect/tissue_depth", effect.tissue_depth);
  readNumber(reader, "effect/tissue_orientation", effect.tissue_orientation);
  readNumber(reader, "effect/tissue_time", effect.tissue_time);
  readNumber(reader, "effect/unrest_time", effect.unrest_time);
  readNumber(reader, "effect/memory", effect.memory);
  readNumber(reader, "effect/doubt", effect.doubt);
  readNumber(reader, "effect/release", effect.release);
  readNumber(reader, "effect/certain", effect.certain);
  readNumber(reader, "effect/standing_time", effect.standing_time);
  readNumber(reader, "effect/unconfirmed_turn", effect.unconfirmed_turn);
  readNumber(reader, "effect/unconfirmed_insertion", effect.unconfirmed_insertion);
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
  readNumber(reader, "safety/max_manual_age", safety.max_manual_age);
  readNumber(reader, "safety/max_manual_repeat", safety.max_manual_repeat);
  readNumber(reader, "safety/manual_neutral", safety.manual_neutral);
  reader.read("safety/max_repeated_errors", safety.max_repeated_errors, 1, 100);
  readNumber(reader, "safety/max_clock_difference", safety.max_clock_difference);
  readNumber(reader, "safety/max_tip_speed", safety.max_tip_speed);
  readNumber(reader, "safety/max_tip_turn", safety.max_tip_turn);
  readNumber(reader, "safety/max_optics_offset", safety.max_optics_offset);
}

void readFrame(ParameterReader& reader, const std::string& path, std::string& frame) {
  reader.read(path, frame);
  if (frame.empty() || frame.front() == '/') {
    reader.addError(path + " = '" + frame + "', expected the name of a tf frame, without a leading slash");
  }
}

void readOwner(ParameterReader& reader, const std::string& path, std::string& name) {
  reader.read(path, name);
  std::string why;
  if (name.empty() || (name[0] != '~' && ros::names::validate(name, why))) return;
  reader.addError(path + " = '" + name + "', expected the name of a node, e.g. tracker or /tracker, or ''");
}

}  // namespace

servo::ControllerConfig controllerConfig(ParameterReader& reader) {
  servo::ControllerConfig config;
  readLaw(reader, config);
  readTarget(reader, config);
  reader.read("dead_zone/inverse", config.dead_zone.inverse);
  readVelocity(reader, "dead_zone/width", config.dead_zone.width);
  reader.read("rest/enabled", config.rest.enabled);
  readNumber(reader, "rest/centre_stop", config.rest.centre_stop);
  readNumber(reader, "rest/centre_start", config.rest.centre_start);
  readNumber(reader, "rest/depth_stop", config.rest.depth_stop);
  readNumber(reader, "rest/depth_start", config.rest.depth_start);
  readNumber(reader, "rest/orientation_stop", config.rest.orientation_stop);
  readNumber(reader, "rest/orientation_start", config.rest.orientation_start);
  readNumber(reader, "rest/hunting_time", config.rest.hunting_time);
  readNumber(reader, "rest/widening", config.rest.widening);
  readNumber(reader, "rest/widest", config.rest.widest);
  reader.read("oscillation/enabled", config.oscillation.enabled);
  readNumber(reader, "oscillation/half_period", config.oscillation.half_period);
  reader.read("oscillation/changes", config.oscillation.changes, 1, 100);
  readNumber(reader, "oscillation/centre", config.oscillation.centre);
  readNumber(reader, "oscillation/depth", config.oscillation.depth);
  readNumber(reader, "oscillation/orientation", config.oscillation.orientation);
  readNumber(reader, "oscillation/step", config.oscillation.step);
  readNumber(reader, "oscillation/least", config.oscillation.least);
  constexpr double kLarge = std::numeric_limits<double>::max();
  readNumber(reader, "range/min_depth", config.range.min_depth);
  readNumber(reader, "range/max_depth", config.range.max_depth);
  readNumber(reader, "range/depth_margin", config.range.depth_margin);
  reader.read("range/axis", config.range.axis, 3, -kLarge, kLarge);
  readNumber(reader, "range/cone", config.range.cone);
  readNumber(reader, "range/cone_margin", config.range.cone_margin);
  reader.read("insertion_point/use", config.insertion_point.use);
  readNumber(reader, "insertion_point/prior_stddev", config.insertion_point.prior_stddev);
  readNumber(reader, "insertion_point/correction_rate", config.insertion_point.correction_rate);
  readNumber(reader, "insertion_point/wobble", config.insertion_point.estimator.wobble);
  readNumber(reader, "insertion_point/warning_residual", config.insertion_point.estimator.warning_residual);
  readNumber(reader, "insertion_point/stop_residual", config.insertion_point.estimator.stop_residual);
  reader.read("horizon/up", config.horizon.up, 3, -kLarge, kLarge);
  readVelocity(reader, "limits/velocity", config.limits.velocity);
  readVelocity(reader, "limits/acceleration", config.limits.acceleration);
  readEffect(reader, config.effect);
  readSafety(reader, config.safety);
  reader.addErrors(servo::validate(config));
  return config;
}

ControllerNodeConfig controllerNodeConfig(ParameterReader& reader) {
  ControllerNodeConfig config;
  reader.read("rate", config.rate, 10.0, 200.0);
  readFrame(reader, "frames/insertion_point", config.insertion_point);
  readFrame(reader, "frames/camera", config.camera);
  readFrame(reader, "frames/shaft", config.shaft);
  reader.read("frame_prefix", config.frame_prefix);
  readOwner(reader, "owners/tf", config.tf_owner);
  readOwner(reader, "owners/task_error", config.owners.task_error);
  readOwner(reader, "owners/operating_state", config.owners.operating_state);
  readOwner(reader, "owners/manual", config.owners.manual);
  readOwner(reader, "owners/dead_man", config.owners.dead_man);
  config.control = controllerConfig(reader);
  readExternalStops(reader, config.external_stops);
  double diagnostic_period = 1.0;  // read again by diagnostic_updater
  reader.read("diagnostic_period", diagnostic_period, 0.1, 60.0);
  reader.refuseUnknown("");
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
