#include "laparoscope_servo/ros/controller_parameters.h"

#include <gtest/gtest.h>

#include "laparoscope_servo/ros/servo_simulation.h"

namespace laparoscope_servo::skin {
namespace {

const std::string kConfig = LAPAROSCOPE_SERVO_CONFIG;  // the folder of the default files

std::vector<double> numbers(const servo::ScopeVelocity& v) {
  return {v.pan, v.tilt, v.spin, v.insertion};
}

// Every number of the configuration, in a fixed order.
std::vector<double> numbers(const ControllerNodeConfig& config) {
  const servo::ControllerConfig& c = config.control;
  const servo::SafetyConfig& s = c.safety;
  std::vector<double> all{config.rate,
                          c.gains.pan,
                          c.gains.tilt,
                          c.gains.spin,
                          c.gains.insertion,
                          c.dead_zone.inverse ? 1.0 : 0.0,
                          s.max_task_error_age,
                          s.max_depth_age,
                          s.min_depth,
                          s.max_depth,
                          s.max_lateral_offset,
                          s.resume_time,
                          s.max_period,
                          s.max_clock_step,
                          s.slow_below,
                          s.hold_below,
                          s.release_hold_above,
                          s.min_visible_for_insertion,
                          s.max_dead_man_age,
                          s.max_robot_state_age,
                          s.max_corner_error_for_insertion,
                          s.dead_man_required ? 1.0 : 0.0,
                          s.robot_required ? 1.0 : 0.0};
  for (const servo::ScopeVelocity& v :
       {c.dead_zone.width, c.dead_zone.stop, c.dead_zone.start, c.limits.velocity, c.limits.acceleration}) {
    for (const double number : numbers(v)) all.push_back(number);
  }
  return all;
}

std::vector<double> numbers(const SimulationConfig& c) {
  std::vector<double> all{c.frame_rate,
                          c.image_delay,
                          c.corner_noise,
                          c.width,
                          c.height,
                          c.camera.fx,
                          c.camera.fy,
                          c.camera.cx,
                          c.camera.cy,
                          c.roi.x,
                          c.roi.y,
                          c.roi.width,
                          c.roi.height,
                          c.tissue_distance,
                          c.tissue_slant_x,
                          c.tissue_slant_y,
                          c.depth,
                          c.scope_length,
                          c.believed_depth_factor,
                          c.start.pan,
                          c.start.tilt,
                          c.start.spin,
                          c.start.insertion,
                          c.robot.delay};
  for (const double width : c.robot.dead_zone) all.push_back(width);
  return all;
}

std::size_t leaves(const XmlRpc::XmlRpcValue& tree) {
  if (tree.getType() != XmlRpc::XmlRpcValue::TypeStruct) return 1;
  std::size_t count = 0;
  for (const auto& member : tree) count += leaves(member.second);
  return count;
}

// The file repeats the defaults: nothing is missing, nothing differs.
TEST(ControllerParameters, FileEqualsTheDefaults) {
  const XmlRpc::XmlRpcValue tree = parametersFromYaml(kConfig + "/controller.yaml");
  ParameterReader reader(tree, "/controller");
  const ControllerNodeConfig config = controllerNodeConfig(reader);
  EXPECT_EQ(reader.report(), "");
  EXPECT_EQ(numbers(config), numbers(ControllerNodeConfig()));
  EXPECT_EQ(config.insertion_point, ControllerNodeConfig().insertion_point);
  EXPECT_EQ(config.camera, ControllerNodeConfig().camera);
  EXPECT_EQ(leaves(tree), numbers(config).size() + 2);  // and the two frames
}

TEST(ControllerParameters, FileOfTheSimulationEqualsTheDefaults) {
  const XmlRpc::XmlRpcValue tree = parametersFromYaml(kConfig + "/simulate_servo.yaml");
  ParameterReader reader(tree, "");
  const SimulationConfig config = simulationConfig(reader);
  reader.refuseUnknown("");
  EXPECT_EQ(reader.report(), "");
  EXPECT_EQ(numbers(config), numbers(SimulationConfig()));
  EXPECT_EQ(config.robot.dead_zone_kind, SimulationConfig().robot.dead_zone_kind);
  EXPECT_EQ(leaves(tree), numbers(config).size() - 4 + 2);  // the dead zone is one list; and its kind
}

// Each leaf of the file, changed, changes the configuration: no parameter is read into the wrong field.
TEST(ControllerParameters, EveryNumberOfTheFileHasAFieldOfItsOwn) {
  const XmlRpc::XmlRpcValue tree = parametersFromYaml(kConfig + "/controller.yaml");
  const std::vector<double> defaults = numbers(ControllerNodeConfig());
  int changed = 0;
  for (const auto& group : tree) {
    if (group.second.getType() != XmlRpc::XmlRpcValue::TypeStruct) continue;
    for (const auto& member : group.second) {
      std::vector<std::string> paths;
      if (member.second.getType() == XmlRpc::XmlRpcValue::TypeStruct) {
        for (const auto& leaf : member.second) paths.push_back(leaf.first);
      } else {
        paths.push_back("");
      }
      for (const std::string& leaf : paths) {
        XmlRpc::XmlRpcValue other = tree;
        XmlRpc::XmlRpcValue& value =
            leaf.empty() ? other[group.first][member.first] : other[group.first][member.first][leaf];
        if (value.getType() != XmlRpc::XmlRpcValue::TypeDouble) continue;
        const double number = static_cast<double>(value);
        value = number * 1.0625;
        ParameterReader reader(other, "");
        const std::vector<double> now = numbers(controllerNodeConfig(reader));
        int differences = 0;
        for (std::size_t k = 0; k < now.size(); ++k) {
          if (now[k] == defaults[k]) continue;
          EXPECT_EQ(defaults[k], number) << group.first << '/' << member.first << '/' << leaf;
          ++differences;
        }
        EXPECT_EQ(differences, 1) << group.first << '/' << member.first << '/' << leaf;
        ++changed;
      }
    }
  }
  EXPECT_EQ(changed, 39);
}

TEST(ControllerParameters, NothingSetGivesTheDefaults) {
  ParameterReader reader(XmlRpc::XmlRpcValue(), "/controller");
  EXPECT_EQ(numbers(controllerNodeConfig(reader)), numbers(ControllerNodeConfig()));
  EXPECT_EQ(reader.report(), "");
}

TEST(ControllerParameters, RefusesAnUnknownName) {
  XmlRpc::XmlRpcValue tree;
  tree["gain"]["pan"] = 0.3;
  ParameterReader reader(tree, "/controller");
  controllerNodeConfig(reader);
  EXPECT_NE(reader.report().find("/controller/gain/pan is no parameter"), std::string::npos) << reader.report();
}

TEST(ControllerParameters, SimulationRefusesGeometryThatCannotBe) {
  XmlRpc::XmlRpcValue tree;
  tree["simulation"]["roi"]["x"] = 600.0;
  tree["simulation"]["start"]["insertion"] = -0.2;
  tree["simulation"]["scope"]["length"] = 0.05;
  tree["simulation"]["robot"]["dead_zone_kind"] = "soft";
  ParameterReader reader(tree, "");
  simulationConfig(reader);
  EXPECT_EQ(reader.errors().size(), 3u) << reader.report();
  tree["simulation"]["start"]["insertion"] = 0.0;
  ParameterReader again(tree, "");
  simulationConfig(again);
  EXPECT_NE(again.report().find("scope/length is too short"), std::string::npos) << again.report();
}

}  // namespace
}  // namespace laparoscope_servo::skin
