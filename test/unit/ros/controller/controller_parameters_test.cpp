#include "ros/controller/controller_parameters.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "ros/simulation/servo_simulation_config.h"

namespace laparoscope_servo {
namespace {

TEST(ControllerParameters, OwnersAreNamesOfNodes) {
  XmlRpc::XmlRpcValue tree;
  tree["owners"]["task_error"] = "/theatre/camera_manager";
  tree["owners"]["operating_state"] = "arm";
  tree["owners"]["manual"] = "joy";
  tree["owners"]["dead_man"] = "pedal";
  ParameterReader reader(tree, "/controller");
  const InputOwners owners = controllerNodeConfig(reader).owners;
  EXPECT_EQ(reader.report(), "");
  EXPECT_EQ(owners.task_error, "/theatre/camera_manager");
  EXPECT_EQ(owners.operating_state, "arm");
  EXPECT_EQ(owners.manual, "joy");
  EXPECT_EQ(owners.dead_man, "pedal");
  for (const char* bad : {"~tracker", "my tracker", "1st", "a\nb"}) {
    tree["owners"]["task_error"] = bad;
    ParameterReader refusing(tree, "/controller");
    controllerNodeConfig(refusing);
    EXPECT_NE(refusing.report().find("owners/task_error"), std::string::npos) << bad;
  }
}

TEST(ControllerParameters, RefusesAnUnknownName) {
  XmlRpc::XmlRpcValue tree;
  tree["gain"]["pan"] = 0.3;
  ParameterReader reader(tree, "/controller");
  controllerNodeConfig(reader);
  EXPECT_NE(reader.report().find("/controller/gain/pan is no parameter"), std::string::npos) << reader.report();
}

TEST(ControllerParameters, SaysWhatIsWrongByItsWholeName) {
  XmlRpc::XmlRpcValue tree;
  tree["gains"]["pan"] = -1.0;
  tree["predictor"]["max_delay"] = 0.1;  // below delay, 0.16
  tree["breathing"]["rate"] = 0.05;
  tree["horizon"]["up"].setSize(3);
  for (int k = 0; k < 3; ++k) tree["horizon"]["up"][k] = 0.0;
  tree["dead_zone"]["width"]["pan"] = 0.1;
  ParameterReader reader(tree, "/controller");
  controllerNodeConfig(reader);
  const std::vector<std::string> expected = {
      "/controller/gains/pan = -1, expected a number in [0, 5] 1/s",
      "/controller/predictor/delay = 0.16, expected at most max_delay = 0.1",
      "/controller/breathing/rate = 0.05, expected 0 or a number in [min_rate, max_rate] Hz",
      "/controller/horizon/up is no direction, expected numbers that are not all zero",
      "/controller/limits/velocity is not above dead_zone/width, expected more in each component"};
  EXPECT_EQ(reader.errors(), expected);
}

TEST(ControllerParameters, SimulationRefusesGeometryThatCannotBe) {
  XmlRpc::XmlRpcValue tree;
  tree["simulation"]["roi"]["x"] = 600.0;
  tree["simulation"]["start"]["insertion"] = -0.2;
  tree["simulation"]["scope"]["length"] = 0.05;
  tree["simulation"]["robot"]["dead_zone_kind"] = "soft";
  const auto errors = [&tree] {
    ParameterReader reader(tree, "");
    ServoSimulationParameters parameters;
    reader.readAll(parameters);
    return reader.errors();
  };
  EXPECT_EQ(errors().size(), 3u);
  tree["simulation"]["start"]["insertion"] = 0.0;
  const std::vector<std::string> again = errors();
  EXPECT_EQ(std::count_if(
                again.begin(), again.end(),
                [](const std::string& error) { return error.find("scope/length is too short") != std::string::npos; }),
            1);
}

}  // namespace
}  // namespace laparoscope_servo
