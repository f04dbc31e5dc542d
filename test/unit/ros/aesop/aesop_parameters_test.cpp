#include "ros/aesop/aesop_parameters.h"

#include <gtest/gtest.h>

#include "ros/aesop/insertion_point_file.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

XmlRpc::XmlRpcValue shipped(const std::string& name) {
  return parametersFromYaml(std::string(LAPAROSCOPE_SERVO_CONFIG) + "/" + name);
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

TEST(EmulatorParameters, theNodesParametersAreAllowedOthersAreNot) {
  XmlRpc::XmlRpcValue tree = mergeParameters(shipped("aesop.yaml"), shipped("emulator.yaml"));
  EXPECT_TRUE(errorsBesideEmulator(tree).empty());
  EXPECT_TRUE(errorsBesideEmulator(XmlRpc::XmlRpcValue()).empty());
  tree["emulatr"]["delay"] = 0.1;
  tree["command"]["timeout"] = -1.0;
  const std::vector<std::string> errors = errorsBesideEmulator(tree);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_NE(errors[1].find("params/emulatr/delay is no parameter"), std::string::npos) << errors[1];
  EXPECT_NE(errors[0].find("command/timeout"), std::string::npos) << errors[0];
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
