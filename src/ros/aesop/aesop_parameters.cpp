#include "ros/aesop/aesop_parameters.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "ros/aesop/insertion_point_file.h"
#include "ros/common/parameter_names.h"

namespace laparoscope_servo {

using parameters::Table;

namespace {

void describe(Table& table, CalibrationParameters& c) {
  table.text("file", c.file, "path of the file for the result; empty: not saved, valid until the node ends");
  table.flag("pattern_allowed", c.pattern_allowed,
             "the method PATTERN may move the arm, without a dead-man switch; calibrate.launch sets true");
  describe(table, c.fit);
  describe(table, c.pattern);
}

void takeCalibratedPoint(AesopParameters& parameters, ParameterReader& reader) {
  parameters.insertion_point_origin = "the parameter insertion_point, not calibrated";
  const std::string& file = parameters.insertion_point_file;
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

void describe(Table& table, AesopParameters& c) {
  table.text("port", c.port, "name of the serial port, which is opened exclusively").required("/dev/ttyUSB0");
  table.number("baud_rate", c.baud_rate, {1200, 1000000}, "bit/s", "8N1, no flow control");
  table.number("realtime_priority", c.realtime_priority, {0, 99}, "",
               "SCHED_FIFO priority of the loop, 20 is enough; 0: none; warned where it is not permitted");
  describeFramePrefix(table, c.frame_prefix);
  table
      .texts("service_callers", c.service_callers,
             "who may call enable, resume and clear_fault, start or finish a calibration; none: every node")
      .accepting(kNodeName, isNodeName);
  table.group("optics", "direction of the optical axis relative to the shaft", [&] {
    table.number("angle", c.optics_angle, {-1.3, 1.3}, "rad",
                 "between the shaft and the optical axis; 0.5236 is a 30 degree scope");
    table.number("roll", c.optics_roll, {-3.2, 3.2}, "rad",
                 "of the camera about the shaft; with 0 it looks down in the picture");
  });
  table.numbers("insertion_point", c.driver.insertion_point.data(), 3, parameters::Range::between(-10, 10), "m",
                "of the trocar in aesop_base");
  table.text("insertion_point_file", c.insertion_point_file,
             "path of a calibration that replaces insertion_point; empty: none");
  table.group("kinematics", "AESOP 3000, nominal: from a public calibration demo of unknown accuracy",
              [&] { describe(table, c.driver.kinematics); });
  table.group("motion", "limits at which the arm is slowed, and at which it stops",
              [&] { describe(table, c.driver.motion); });
  table.group("command", "which velocities are executed", [&] {
    table
        .text("publisher", c.publisher,
              "the only node whose commands are accepted; without a leading slash, in the namespace of this one")
        .accepting(kNodeName, isNodeName);
    describe(table, c.driver.command);
  });
  table.group("link", "the link to the arm's controller", [&] { describe(table, c.driver.session); });
  table.group("reconnect", "to a port that could not be opened or has gone; always into DISABLED",
              [&] { describe(table, c.reconnect); });
  table.group("wire_log", "recording of the serial line, for the tool wire_log", [&] { describe(table, c.wire_log); });
  describe(table, c.external_stops);
  table.group("monitor", "joints whose reported motion does not follow their commands disable the arm",
              [&] { describe(table, c.driver.monitor); });
  table.group("calibration", "of the insertion point, by the services calibrate_insertion_point/...",
              [&] { describe(table, c.calibration); });
}

std::vector<std::string> validate(const AesopParameters& c) {
  std::vector<std::string> errors = parameters::errorsOf(c);
  const auto add = [&errors](const std::string& group, const std::vector<std::string>& more) {
    for (const std::string& error : more) {
      if (std::find(errors.begin(), errors.end(), group + error) == errors.end()) errors.push_back(group + error);
    }
  };
  add("", aesop::validate(c.driver));
  add("calibration/", servo::validate(c.calibration.fit));
  return errors;
}

AesopParameters readAesopParameters(ParameterReader& reader) {
  AesopParameters parameters;
  reader.readAll(parameters);
  takeCalibratedPoint(parameters, reader);
  return parameters;
}

sim::EmulatorConfig readEmulatorConfig(ParameterReader& reader) {
  sim::EmulatorConfig config;
  Table table;
  describe(table, config);
  reader.read(table);
  for (const char* group : {"kinematics", "emulator"}) reader.refuseUnknown(group);
  reader.addJudgement(sim::validate(config));
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
