#include "ros/aesop/aesop_parameters.h"

#include <gtest/gtest.h>

#include "ros/aesop/insertion_point_file.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

XmlRpc::XmlRpcValue shipped(const std::string& name) {
  return parametersFromYaml(std::string(LAPAROSCOPE_SERVO_CONFIG) + "/" + name);
}

void expectSame(const aesop::KinematicsConfig& a, const aesop::KinematicsConfig& b) {
  for (std::size_t k = 0; k < aesop::kJoints; ++k) {
    SCOPED_TRACE("joint " + std::to_string(k + 1));
    EXPECT_EQ(a.joints[k].prismatic, b.joints[k].prismatic);
    EXPECT_EQ(a.joints[k].role, b.joints[k].role);
    for (double aesop::DhJoint::*field :
         {&aesop::DhJoint::alpha, &aesop::DhJoint::a, &aesop::DhJoint::d, &aesop::DhJoint::theta,
          &aesop::DhJoint::minimum, &aesop::DhJoint::maximum, &aesop::DhJoint::max_speed}) {
      EXPECT_NEAR(a.joints[k].*field, b.joints[k].*field, 1e-15);
    }
  }
  EXPECT_EQ(a.scope_length, b.scope_length);
  EXPECT_EQ(a.depth_minimum, b.depth_minimum);
  EXPECT_EQ(a.depth_maximum, b.depth_maximum);
}

TEST(AesopParameters, shippedFileIsTheDefaults) {
  XmlRpc::XmlRpcValue tree = shipped("aesop.yaml");
  tree["port"] = std::string("/dev/ttyUSB0");
  ParameterReader reader(tree, "/aesop");
  const AesopParameters read = readAesopParameters(reader);
  ASSERT_TRUE(reader.errors().empty()) << reader.report();
  const AesopParameters defaults;
  EXPECT_EQ(read.port, "/dev/ttyUSB0");
  EXPECT_EQ(read.baud_rate, defaults.baud_rate);
  EXPECT_EQ(read.realtime_priority, defaults.realtime_priority);
  EXPECT_EQ(read.frame_prefix, defaults.frame_prefix);
  expectSame(read.driver.kinematics, defaults.driver.kinematics);
  EXPECT_EQ(read.driver.insertion_point, defaults.driver.insertion_point);
  EXPECT_EQ(read.driver.motion.limit_margin_angle, defaults.driver.motion.limit_margin_angle);
  EXPECT_EQ(read.driver.motion.limit_margin_distance, defaults.driver.motion.limit_margin_distance);
  EXPECT_EQ(read.driver.motion.singular_slow, defaults.driver.motion.singular_slow);
  EXPECT_EQ(read.driver.motion.singular_stop, defaults.driver.motion.singular_stop);
  EXPECT_EQ(read.driver.motion.lever_slow, defaults.driver.motion.lever_slow);
  EXPECT_EQ(read.driver.motion.lever_stop, defaults.driver.motion.lever_stop);
  EXPECT_EQ(read.driver.motion.stopping_time, defaults.driver.motion.stopping_time);
  EXPECT_EQ(read.driver.command.timeout, defaults.driver.command.timeout);
  EXPECT_EQ(read.driver.command.max_stamp_age, defaults.driver.command.max_stamp_age);
  EXPECT_EQ(read.driver.command.max_stamp_lead, defaults.driver.command.max_stamp_lead);
  EXPECT_EQ(read.external_stops.master.period, defaults.external_stops.master.period);
  EXPECT_EQ(read.external_stops.master.hold, defaults.external_stops.master.hold);
  EXPECT_EQ(read.external_stops.master.patience, defaults.external_stops.master.patience);
  EXPECT_EQ(read.external_stops.stop_line.path, defaults.external_stops.stop_line.path);
  EXPECT_EQ(read.external_stops.stop_line.signal, defaults.external_stops.stop_line.signal);
  EXPECT_EQ(read.external_stops.stop_line.release, defaults.external_stops.stop_line.release);
  EXPECT_EQ(read.external_stops.stop_line.rate, defaults.external_stops.stop_line.rate);
  EXPECT_EQ(read.external_stops.stop_line.patience, defaults.external_stops.stop_line.patience);
  EXPECT_EQ(read.driver.command.max_pan, defaults.driver.command.max_pan);
  EXPECT_EQ(read.driver.command.max_tilt, defaults.driver.command.max_tilt);
  EXPECT_EQ(read.driver.command.max_spin, defaults.driver.command.max_spin);
  EXPECT_EQ(read.driver.command.max_insertion, defaults.driver.command.max_insertion);
  EXPECT_EQ(read.reconnect.first_pause, defaults.reconnect.first_pause);
  EXPECT_EQ(read.reconnect.longest_pause, defaults.reconnect.longest_pause);
  EXPECT_EQ(read.reconnect.stable_time, defaults.reconnect.stable_time);
  EXPECT_EQ(read.publisher, defaults.publisher);
  EXPECT_EQ(read.service_callers, defaults.service_callers);
  EXPECT_EQ(read.driver.session.rate, defaults.driver.session.rate);
  EXPECT_EQ(read.driver.session.time_to_live, defaults.driver.session.time_to_live);
  EXPECT_EQ(read.driver.session.status_timeout, defaults.driver.session.status_timeout);
  EXPECT_EQ(read.driver.session.request_timeout, defaults.driver.session.request_timeout);
  EXPECT_EQ(read.driver.session.codec()->name(), defaults.driver.session.codec()->name());
  EXPECT_EQ(read.wire_log.file, defaults.wire_log.file);
  EXPECT_EQ(read.wire_log.size, defaults.wire_log.size);
  EXPECT_EQ(read.wire_log.files, defaults.wire_log.files);
  EXPECT_EQ(read.driver.monitor.response_time, defaults.driver.monitor.response_time);
  EXPECT_EQ(read.driver.monitor.slowest_angle, defaults.driver.monitor.slowest_angle);
  EXPECT_EQ(read.driver.monitor.slowest_distance, defaults.driver.monitor.slowest_distance);
  EXPECT_EQ(read.driver.monitor.tolerance_angle, defaults.driver.monitor.tolerance_angle);
  EXPECT_EQ(read.driver.monitor.tolerance_distance, defaults.driver.monitor.tolerance_distance);
  EXPECT_EQ(read.insertion_point_file, defaults.insertion_point_file);
  EXPECT_EQ(read.calibration.file, defaults.calibration.file);
  EXPECT_EQ(read.calibration.pattern_allowed, defaults.calibration.pattern_allowed);
  const servo::InsertionPointFitConfig& fit = read.calibration.fit;
  EXPECT_EQ(fit.spacing, defaults.calibration.fit.spacing);
  EXPECT_EQ(fit.min_poses, defaults.calibration.fit.min_poses);
  EXPECT_EQ(fit.max_poses, defaults.calibration.fit.max_poses);
  EXPECT_EQ(fit.min_cone, defaults.calibration.fit.min_cone);
  EXPECT_EQ(fit.max_residual, defaults.calibration.fit.max_residual);
  EXPECT_EQ(fit.max_stddev, defaults.calibration.fit.max_stddev);
  EXPECT_EQ(fit.position_noise, defaults.calibration.fit.position_noise);
  EXPECT_EQ(fit.direction_noise, defaults.calibration.fit.direction_noise);
  EXPECT_EQ(fit.wobble, defaults.calibration.fit.wobble);
  const aesop::PatternConfig& pattern = read.calibration.pattern;
  EXPECT_EQ(pattern.angle, defaults.calibration.pattern.angle);
  EXPECT_EQ(pattern.speed, defaults.calibration.pattern.speed);
  EXPECT_EQ(pattern.max_depth_change, defaults.calibration.pattern.max_depth_change);
  EXPECT_EQ(pattern.patience, defaults.calibration.pattern.patience);
}

TEST(AesopParameters, aCalibratedInsertionPointTakesThePlaceOfTheConfiguredOne) {
  const test_support::TemporaryFolder folder;
  CalibratedInsertionPoint calibrated;
  calibrated.point = Eigen::Vector3d(0.58, -0.07, -0.04);
  calibrated.method = "HAND";
  calibrated.date = "2026-01-02T03:04:05Z";
  calibrated.poses = {aesop::JointVector::Zero()};
  calibrated.residual = residual(aesop::Kinematics(aesop::KinematicsConfig()), calibrated.poses, calibrated.point);
  XmlRpc::XmlRpcValue tree = shipped("aesop.yaml");
  tree["port"] = std::string("/dev/ttyUSB0");
  {
    ParameterReader reader(tree, "/aesop");
    EXPECT_NE(readAesopParameters(reader).insertion_point_origin.find("not calibrated"), std::string::npos);
  }
  tree["insertion_point_file"] = folder.file("point.yaml");
  {
    ParameterReader reader(tree, "/aesop");
    readAesopParameters(reader);
    ASSERT_EQ(reader.errors().size(), 1u) << "a file that is named has to be there";
    EXPECT_NE(reader.errors()[0].find("point.yaml"), std::string::npos) << reader.errors()[0];
  }
  saveInsertionPoint(folder.file("point.yaml"), calibrated);
  ParameterReader reader(tree, "/aesop");
  const AesopParameters read = readAesopParameters(reader);
  EXPECT_TRUE(reader.errors().empty()) << reader.report();
  EXPECT_EQ(read.driver.insertion_point, calibrated.point);
  EXPECT_NE(read.insertion_point_origin.find("2026-01-02"), std::string::npos) << read.insertion_point_origin;
}

TEST(AesopParameters, everyParameterOfTheShippedFileIsRead) {
  XmlRpc::XmlRpcValue tree = shipped("aesop.yaml");
  tree["port"] = std::string("/dev/ttyUSB0");
  for (const char* group :
       {"motion", "command", "link", "reconnect", "monitor", "calibration", "master", "stop_line"}) {
    for (auto& member : tree[group]) {
      if (member.first == "file" || member.first == "path") continue;  // any text is right
      XmlRpc::XmlRpcValue changed = tree;
      changed[group][member.first] = std::string("no number, no name");
      ParameterReader reader(changed, "/aesop");
      readAesopParameters(reader);
      EXPECT_EQ(reader.errors().size(), 1u) << group << "/" << member.first;
    }
  }
}

TEST(AesopParameters, namesOfNodesHaveToBeNames) {
  const auto errors = [](const XmlRpc::XmlRpcValue& publisher, const XmlRpc::XmlRpcValue& caller) {
    XmlRpc::XmlRpcValue tree = shipped("aesop.yaml");
    tree["port"] = std::string("/dev/ttyUSB0");
    tree["command"]["publisher"] = publisher;
    tree["service_callers"][0] = caller;
    ParameterReader reader(tree, "/aesop");
    readAesopParameters(reader);
    return reader.errors();
  };
  EXPECT_TRUE(errors("controller", "/left/rqt_gui").empty());
  for (const char* wrong : {"", "~controller", "a controller", "1controller", "/con-troller"}) {
    ASSERT_EQ(errors(wrong, "/rqt_gui").size(), 1u) << wrong;
    EXPECT_NE(errors(wrong, "/rqt_gui")[0].find(std::string("command/publisher = '") + wrong), std::string::npos);
    ASSERT_EQ(errors("/controller", wrong).size(), 1u) << wrong;
    EXPECT_NE(errors("/controller", wrong)[0].find("service_callers"), std::string::npos);
  }
  EXPECT_EQ(errors(5, "/rqt_gui").size(), 1u);
  EXPECT_EQ(errors("/controller", 5).size(), 1u);
}

TEST(EmulatorParameters, shippedFilesAreTheDefaults) {
  ParameterReader reader(mergeParameters(shipped("aesop.yaml"), shipped("emulator.yaml")), "params");
  const sim::EmulatorConfig read = readEmulatorConfig(reader);
  ASSERT_TRUE(reader.errors().empty()) << reader.report();
  const sim::EmulatorConfig defaults;
  expectSame(read.kinematics, defaults.kinematics);
  EXPECT_EQ(read.arm.start, defaults.arm.start);
  EXPECT_EQ(read.arm.insertion_point, defaults.arm.insertion_point);
  EXPECT_EQ(read.arm.delay, defaults.arm.delay);
  EXPECT_EQ(read.arm.dead_zone, defaults.arm.dead_zone);
  EXPECT_EQ(read.codec()->name(), defaults.codec()->name());
  EXPECT_EQ(read.arm.breakaway, defaults.arm.breakaway);
  EXPECT_EQ(read.arm.time_constant, defaults.arm.time_constant);
}

TEST(EmulatorParameters, theNodesParametersAreAllowedOthersAreNot) {
  XmlRpc::XmlRpcValue tree = mergeParameters(shipped("aesop.yaml"), shipped("emulator.yaml"));
  EXPECT_TRUE(errorsBesideEmulator(tree).empty());
  EXPECT_TRUE(errorsBesideEmulator(XmlRpc::XmlRpcValue()).empty());
  tree["emulatr"]["delay"] = 0.1;
  tree["command"]["timeout"] = -1.0;
  const std::vector<std::string> errors = errorsBesideEmulator(tree);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_NE(errors[0].find("params/emulatr/delay is no parameter"), std::string::npos) << errors[0];
  EXPECT_NE(errors[1].find("command/timeout"), std::string::npos) << errors[1];
}

TEST(EmulatorParameters, trocarOfTheNodeAndOfTheEmulatorAgree) {
  EXPECT_EQ(aesop::DriverConfig().insertion_point, sim::ArmConfig().insertion_point);
}

TEST(AesopParameters, portIsRequired) {
  ParameterReader reader(XmlRpc::XmlRpcValue(), "/aesop");
  readAesopParameters(reader);
  ASSERT_EQ(reader.errors().size(), 1u);
  EXPECT_NE(reader.errors()[0].find("/aesop/port is not set"), std::string::npos);
}

std::string errorsWith(const std::string& name, const std::vector<double>& numbers) {
  XmlRpc::XmlRpcValue tree;
  tree["port"] = std::string("p");
  XmlRpc::XmlRpcValue list;
  for (std::size_t k = 0; k < numbers.size(); ++k) list[static_cast<int>(k)] = numbers[k];
  tree["kinematics"][name] = list;
  ParameterReader reader(tree, "/aesop");
  readAesopParameters(reader);
  return reader.report();
}

TEST(AesopParameters, jointNumbers) {
  EXPECT_EQ(errorsWith("driven", {1, 2, 3, 7}), "");
  EXPECT_NE(errorsWith("driven", {1, 2, 3, 8}), "");
  EXPECT_NE(errorsWith("driven", {1, 2, 3, 2.5}), "");
  EXPECT_NE(errorsWith("driven", {1, 2, 3, 4}).find("joint 4 is listed as driven and as by_hand"), std::string::npos);
  EXPECT_NE(errorsWith("by_hand", {4, 5}).find("number of passive joints = 1"), std::string::npos);
  EXPECT_NE(errorsWith("prismatic", {1, 5}).find("passive and prismatic"), std::string::npos);
  EXPECT_NE(errorsWith("alpha", {0, 0, 0}), "");
}

}  // namespace
}  // namespace laparoscope_servo
