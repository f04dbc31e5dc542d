#include "ros/aesop/aesop_parameters.h"

#include <ros/names.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "ros/aesop/insertion_point_file.h"

namespace laparoscope_servo {

namespace {

using aesop::DhJoint;
using aesop::JointRole;

constexpr int kMany = 1000000;
constexpr double kLarge = 100.0;  // m or rad: beyond it a number is a typing error; narrower bounds are validate()'s

std::vector<double> gather(const std::array<DhJoint, aesop::kJoints>& joints, double DhJoint::*field) {
  std::vector<double> values;
  for (const DhJoint& joint : joints) values.push_back(joint.*field);
  return values;
}

void readField(ParameterReader& reader, const std::string& path, std::array<DhJoint, aesop::kJoints>& joints,
               double DhJoint::*field) {
  std::vector<double> values = gather(joints, field);
  reader.read(path, values, aesop::kJoints, -kLarge, kLarge);
  for (std::size_t k = 0; k < joints.size(); ++k) joints[k].*field = values[k];
}

// Joint numbers, 1 to 7, as a list; `apply(index, listed)` for every joint when the list is there and right.
template <typename Apply>
void readJointNumbers(ParameterReader& reader, const std::string& path, Apply apply) {
  if (!reader.has(path)) return;
  const std::size_t errors = reader.errors().size();
  std::vector<double> numbers;
  reader.read(path, numbers, 0, 1.0, aesop::kJoints);
  if (reader.errors().size() != errors) return;
  for (const double number : numbers) {
    if (number != std::floor(number)) return reader.addError(path + ": joint numbers are whole, 1 to 7");
  }
  for (std::size_t k = 0; k < aesop::kJoints; ++k) {
    apply(k, std::find(numbers.begin(), numbers.end(), static_cast<double>(k + 1)) != numbers.end());
  }
}

void readRoles(ParameterReader& reader, std::array<DhJoint, aesop::kJoints>& joints) {
  readJointNumbers(reader, "kinematics/prismatic", [&](std::size_t k, bool listed) { joints[k].prismatic = listed; });
  // Both lists together say what every joint is, so either one alone starts from the other's default.
  std::array<bool, aesop::kJoints> driven{};
  std::array<bool, aesop::kJoints> by_hand{};
  for (std::size_t k = 0; k < joints.size(); ++k) {
    driven[k] = joints[k].role == JointRole::kDriven;
    by_hand[k] = joints[k].role == JointRole::kHand;
  }
  readJointNumbers(reader, "kinematics/driven", [&](std::size_t k, bool listed) { driven[k] = listed; });
  readJointNumbers(reader, "kinematics/by_hand", [&](std::size_t k, bool listed) { by_hand[k] = listed; });
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (driven[k] && by_hand[k])
      reader.addError("joint " + std::to_string(k + 1) + " is listed as driven and as by_hand");
    joints[k].role = driven[k] ? JointRole::kDriven : by_hand[k] ? JointRole::kHand : JointRole::kPassive;
  }
}

void readKinematics(ParameterReader& reader, aesop::KinematicsConfig& config) {
  readRoles(reader, config.joints);
  readField(reader, "kinematics/alpha", config.joints, &DhJoint::alpha);
  readField(reader, "kinematics/a", config.joints, &DhJoint::a);
  readField(reader, "kinematics/d", config.joints, &DhJoint::d);
  readField(reader, "kinematics/theta", config.joints, &DhJoint::theta);
  readField(reader, "kinematics/minimum", config.joints, &DhJoint::minimum);
  readField(reader, "kinematics/maximum", config.joints, &DhJoint::maximum);
  readField(reader, "kinematics/max_speed", config.joints, &DhJoint::max_speed);
  reader.read("kinematics/scope_length", config.scope_length, -kLarge, kLarge);
  reader.read("kinematics/depth_minimum", config.depth_minimum, -kLarge, kLarge);
  reader.read("kinematics/depth_maximum", config.depth_maximum, -kLarge, kLarge);
  reader.refuseUnknown("kinematics");
}

void readPoint(ParameterReader& reader, const std::string& path, Eigen::Vector3d& point) {
  std::vector<double> values(point.data(), point.data() + 3);
  reader.read(path, values, 3, -kLarge, kLarge);
  point = Eigen::Vector3d(values[0], values[1], values[2]);
}

void readJoints(ParameterReader& reader, const std::string& path, aesop::JointVector& joints) {
  std::vector<double> values(joints.data(), joints.data() + aesop::kJoints);
  reader.read(path, values, aesop::kJoints, -kLarge, kLarge);
  for (int k = 0; k < aesop::kJoints; ++k) joints[k] = values[static_cast<std::size_t>(k)];
}

void readMotion(ParameterReader& reader, aesop::MotionConfig& config) {
  reader.read("motion/limit_margin_angle", config.limit_margin_angle, -kLarge, kLarge);
  reader.read("motion/limit_margin_distance", config.limit_margin_distance, -kLarge, kLarge);
  reader.read("motion/singular_slow", config.singular_slow, -kLarge, kLarge);
  reader.read("motion/singular_stop", config.singular_stop, -kLarge, kLarge);
  reader.read("motion/lever_slow", config.lever_slow, -kLarge, kLarge);
  reader.read("motion/lever_stop", config.lever_stop, -kLarge, kLarge);
  reader.read("motion/stopping_time", config.stopping_time, -kLarge, kLarge);
  reader.refuseUnknown("motion");
}

void checkNodeName(ParameterReader& reader, const std::string& path, const std::string& name) {
  std::string why;
  if (!name.empty() && name[0] != '~' && ros::names::validate(name, why)) return;
  reader.addError(path + " = '" + name + "', expected the name of a node, e.g. controller or /controller");
}

void readCommand(ParameterReader& reader, std::string& publisher, aesop::CommandConfig& config) {
  reader.read("command/publisher", publisher);
  checkNodeName(reader, "command/publisher", publisher);
  reader.read("command/timeout", config.timeout, -kLarge, kLarge);
  reader.read("command/max_stamp_age", config.max_stamp_age, -kLarge, kLarge);
  reader.read("command/max_stamp_lead", config.max_stamp_lead, -kLarge, kLarge);
  reader.read("command/max_pan", config.max_pan, -kLarge, kLarge);
  reader.read("command/max_tilt", config.max_tilt, -kLarge, kLarge);
  reader.read("command/max_spin", config.max_spin, -kLarge, kLarge);
  reader.read("command/max_insertion", config.max_insertion, -kLarge, kLarge);
  reader.refuseUnknown("command");
}

void readCodec(ParameterReader& reader, const std::string& path, aesop::CodecFactory& codec) {
  if (!reader.has(path)) return;
  std::string name = aesop::codecNames().front();
  reader.read(path, name, aesop::codecNames());
  codec = aesop::codecNamed(name);
}

void readLink(ParameterReader& reader, aesop::SessionConfig& config) {
  reader.read("link/rate", config.rate, 0.0, 1000.0);
  reader.read("link/time_to_live", config.time_to_live, -kLarge, kLarge);
  reader.read("link/status_timeout", config.status_timeout, -kLarge, kLarge);
  reader.read("link/request_timeout", config.request_timeout, -kLarge, kLarge);
  readCodec(reader, "link/codec", config.codec);
  reader.refuseUnknown("link");
}

void readWireLog(ParameterReader& reader, aesop::WireLogConfig& config) {
  reader.read("wire_log/file", config.file);
  reader.read("wire_log/size", config.size, -kLarge, 1e4);
  reader.read("wire_log/files", config.files, -1000, 1000);
  reader.refuseUnknown("wire_log");
  for (const std::string& error : aesop::validate(config)) reader.addError("wire_log/" + error);
}

void readReconnect(ParameterReader& reader, aesop::ReconnectConfig& config) {
  reader.read("reconnect/first_pause", config.first_pause, -kLarge, kLarge);
  reader.read("reconnect/longest_pause", config.longest_pause, -kLarge, kLarge);
  reader.read("reconnect/stable_time", config.stable_time, -1e4, 1e4);
  reader.refuseUnknown("reconnect");
  for (const std::string& error : aesop::validate(config)) reader.addError("reconnect/" + error);
}

void readMonitor(ParameterReader& reader, aesop::MonitorConfig& config) {
  reader.read("monitor/response_time", config.response_time, -kLarge, kLarge);
  reader.read("monitor/slowest_angle", config.slowest_angle, -kLarge, kLarge);
  reader.read("monitor/slowest_distance", config.slowest_distance, -kLarge, kLarge);
  reader.read("monitor/tolerance_angle", config.tolerance_angle, -kLarge, kLarge);
  reader.read("monitor/tolerance_distance", config.tolerance_distance, -kLarge, kLarge);
  reader.refuseUnknown("monitor");
}

void readCalibration(ParameterReader& reader, CalibrationParameters& calibration) {
  servo::InsertionPointFitConfig& fit = calibration.fit;
  reader.read("calibration/file", calibration.file);
  reader.read("calibration/pattern_allowed", calibration.pattern_allowed);
  reader.read("calibration/spacing", fit.spacing, -kLarge, kLarge);
  reader.read("calibration/min_poses", fit.min_poses, -kMany, kMany);
  reader.read("calibration/max_poses", fit.max_poses, -kMany, kMany);
  reader.read("calibration/min_cone", fit.min_cone, -kLarge, kLarge);
  reader.read("calibration/max_residual", fit.max_residual, -kLarge, kLarge);
  reader.read("calibration/max_stddev", fit.max_stddev, -kLarge, kLarge);
  reader.read("calibration/position_noise", fit.position_noise, -kLarge, kLarge);
  reader.read("calibration/direction_noise", fit.direction_noise, -kLarge, kLarge);
  reader.read("calibration/wobble", fit.wobble, -kLarge, kLarge);
  reader.read("calibration/pattern_angle", calibration.pattern.angle, -kLarge, kLarge);
  reader.read("calibration/pattern_speed", calibration.pattern.speed, -kLarge, kLarge);
  reader.read("calibration/pattern_max_depth_change", calibration.pattern.max_depth_change, -kLarge, kLarge);
  reader.read("calibration/pattern_patience", calibration.pattern.patience, -kLarge, kLarge);
  reader.refuseUnknown("calibration");
  for (const std::string& error : servo::validate(fit)) reader.addError("calibration/" + error);
  for (const std::string& error : aesop::validate(calibration.pattern)) reader.addError("calibration/" + error);
}

void readInsertionPoint(ParameterReader& reader, AesopParameters& parameters) {
  readPoint(reader, "insertion_point", parameters.driver.insertion_point);
  parameters.insertion_point_origin = "the parameter insertion_point, not calibrated";
  const std::string& file = parameters.insertion_point_file;
  reader.read("insertion_point_file", parameters.insertion_point_file);
  if (file.empty() || !aesop::validate(parameters.driver.kinematics).empty()) return;
  try {
    const CalibratedInsertionPoint calibrated =
        loadInsertionPoint(file, aesop::Kinematics(parameters.driver.kinematics));
    parameters.driver.insertion_point = calibrated.point;
    std::ostringstream text;
    text << file << ", calibrated " << calibrated.date << " by " << calibrated.method << ", standard deviation "
         << calibrated.stddev << " m";
    parameters.insertion_point_origin = text.str();
  } catch (const std::runtime_error& error) {
    reader.addError(error.what());
  }
}

}  // namespace

AesopParameters readAesopParameters(ParameterReader& reader) {
  AesopParameters parameters;
  reader.require("port", "the name of the serial port, e.g. /dev/ttyUSB0");
  reader.read("port", parameters.port);
  reader.read("baud_rate", parameters.baud_rate, 1200, 1000000);
  reader.read("realtime_priority", parameters.realtime_priority, 0, 99);
  reader.read("frame_prefix", parameters.frame_prefix);
  reader.read("service_callers", parameters.service_callers);
  for (const std::string& caller : parameters.service_callers) checkNodeName(reader, "service_callers", caller);
  reader.read("optics/angle", parameters.optics_angle, -1.3, 1.3);
  reader.read("optics/roll", parameters.optics_roll, -3.2, 3.2);
  readKinematics(reader, parameters.driver.kinematics);
  readMotion(reader, parameters.driver.motion);
  readCommand(reader, parameters.publisher, parameters.driver.command);
  readLink(reader, parameters.driver.session);
  readWireLog(reader, parameters.wire_log);
  readReconnect(reader, parameters.reconnect);
  readExternalStops(reader, parameters.external_stops);
  readMonitor(reader, parameters.driver.monitor);
  readCalibration(reader, parameters.calibration);
  readInsertionPoint(reader, parameters);
  reader.refuseUnknown("");
  reader.addErrors(aesop::validate(parameters.driver));
  return parameters;
}

sim::EmulatorConfig readEmulatorConfig(ParameterReader& reader) {
  sim::EmulatorConfig config;
  readKinematics(reader, config.kinematics);
  readJoints(reader, "emulator/start", config.arm.start);
  readPoint(reader, "emulator/insertion_point", config.arm.insertion_point);
  reader.read("emulator/delay", config.arm.delay, -kLarge, kLarge);
  readJoints(reader, "emulator/dead_zone", config.arm.dead_zone);
  reader.read("emulator/breakaway", config.arm.breakaway, -kLarge, kLarge);
  reader.read("emulator/time_constant", config.arm.time_constant, -kLarge, kLarge);
  readCodec(reader, "emulator/codec", config.codec);
  reader.refuseUnknown("emulator");
  reader.addErrors(sim::validate(config));
  return config;
}

std::vector<std::string> errorsBesideEmulator(const XmlRpc::XmlRpcValue& tree) {
  XmlRpc::XmlRpcValue rest;
  if (tree.getType() != XmlRpc::XmlRpcValue::TypeStruct) return {};
  for (const auto& member : tree) {
    if (member.first != "kinematics" && member.first != "emulator") rest[member.first] = member.second;
  }
  if (!rest.valid()) return {};
  if (!rest.hasMember("port")) rest["port"] = std::string("the emulator's own");
  ParameterReader reader(rest, "params");
  readAesopParameters(reader);
  return reader.errors();
}

}  // namespace laparoscope_servo
