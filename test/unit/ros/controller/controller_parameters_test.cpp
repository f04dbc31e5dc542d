#include "ros/controller/controller_parameters.h"

#include <gtest/gtest.h>

#include "laparoscope_servo/closed_loop/servo_simulation.h"
#include "ros/simulation/servo_simulation_config.h"

namespace laparoscope_servo {
namespace {

const std::string kConfig = LAPAROSCOPE_SERVO_CONFIG;  // the folder of the default files

std::vector<double> numbers(const scope::Velocity& v) {
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
                          static_cast<double>(c.law),
                          static_cast<double>(c.spin),
                          c.features.centre,
                          c.features.depth,
                          c.features.orientation,
                          c.features.desired_depth,
                          c.predictor.enabled ? 1.0 : 0.0,
                          c.predictor.delay,
                          c.predictor.measure_delay ? 1.0 : 0.0,
                          c.predictor.min_delay,
                          c.predictor.max_delay,
                          c.breathing.enabled ? 1.0 : 0.0,
                          c.breathing.rate,
                          c.breathing.rate_stddev,
                          c.breathing.filter.min_frequency,
                          c.breathing.filter.max_frequency,
                          c.predictor.feed_forward ? 1.0 : 0.0,
                          c.predictor.command_lifetime,
                          c.target.centre_noise,
                          c.target.depth_noise,
                          c.target.orientation_noise,
                          c.target.centre_wander,
                          c.target.depth_wander,
                          c.target.orientation_wander,
                          c.target.centre_acceleration,
                          c.target.depth_acceleration,
                          c.target.orientation_acceleration,
                          c.target.calibration,
                          c.target.significance,
                          c.target.jump,
                          c.target.damping,
                          c.rest.enabled ? 1.0 : 0.0,
                          c.rest.centre_stop,
                          c.rest.centre_start,
                          c.rest.depth_stop,
                          c.rest.depth_start,
                          c.rest.orientation_stop,
                          c.rest.orientation_start,
                          c.rest.hunting_time,
                          c.rest.widening,
                          c.rest.widest,
                          c.oscillation.enabled ? 1.0 : 0.0,
                          c.oscillation.half_period,
                          static_cast<double>(c.oscillation.changes),
                          c.oscillation.centre,
                          c.oscillation.depth,
                          c.oscillation.orientation,
                          c.oscillation.step,
                          c.oscillation.least,
                          c.effect.enabled ? 1.0 : 0.0,
                          c.effect.tissue_centre,
                          c.effect.tissue_depth,
                          c.effect.tissue_orientation,
                          c.effect.tissue_time,
                          c.effect.unrest_time,
                          c.effect.memory,
                          c.effect.doubt,
                          c.effect.release,
                          c.effect.certain,
                          c.effect.standing_time,
                          c.effect.unconfirmed_turn,
                          c.effect.unconfirmed_insertion,
                          c.range.min_depth,
                          c.range.max_depth,
                          c.range.depth_margin,
                          c.range.cone,
                          c.range.cone_margin,
                          c.insertion_point.use ? 1.0 : 0.0,
                          c.insertion_point.prior_stddev,
                          c.insertion_point.correction_rate,
                          c.insertion_point.estimator.warning_residual,
                          c.insertion_point.estimator.stop_residual,
                          c.insertion_point.estimator.wobble,
                          s.max_clock_step,
                          s.max_tip_speed,
                          s.max_tip_turn,
                          s.max_optics_offset,
                          s.slow_below,
                          s.hold_below,
                          s.release_hold_above,
                          s.min_visible_for_insertion,
                          s.max_dead_man_age,
                          s.max_robot_state_age,
                          s.max_manual_age,
                          s.max_manual_repeat,
                          s.manual_neutral,
                          static_cast<double>(s.max_repeated_errors),
                          s.max_clock_difference,
                          s.max_corner_error_for_insertion,
                          s.dead_man_required ? 1.0 : 0.0,
                          s.robot_required ? 1.0 : 0.0,
                          config.external_stops.master.period,
                          config.external_stops.master.hold,
                          config.external_stops.master.patience,
                          static_cast<double>(config.external_stops.stop_line.release),
                          config.external_stops.stop_line.rate,
                          config.external_stops.stop_line.patience};
  for (const scope::Velocity& v : {c.dead_zone.width, c.limits.velocity, c.limits.acceleration}) {
    for (const double number : numbers(v)) all.push_back(number);
  }
  for (const std::vector<double>& v : {c.range.axis, c.horizon.up}) all.insert(all.end(), v.begin(), v.end());
  return all;
}

std::vector<double> numbers(const closed_loop::SimulationConfig& c) {
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
                          c.start_spread.pan,
                          c.start_spread.tilt,
                          c.start_spread.spin,
                          c.start_spread.insertion,
                          c.duration,
                          c.rest_from,
                          c.robot.delay,
                          c.optics_angle,
                          c.optics_roll,
                          c.reports ? 1.0 : 0.0,
                          c.report_noise,
                          c.poses ? 1.0 : 0.0,
                          c.pose_noise,
                          c.direction_noise,
                          static_cast<double>(c.wrist),
                          c.picture.roll,
                          c.picture.frozen_from,
                          c.crossing.period,
                          c.crossing.duration,
                          c.crossing.cover,
                          c.crossing.noise,
                          c.patient.pull.distance,
                          c.patient.pull.time,
                          c.patient.pull.period,
                          c.patient.breathing.frequency,
                          c.patient.breathing.second_harmonic,
                          c.patient.breathing.third_harmonic,
                          c.patient.breathing.start,
                          c.patient.breathing.end,
                          c.patient.drift_end,
                          c.patient.jump_time,
                          c.patient.tilt,
                          c.patient.tilt_frequency};
  for (const double width : c.robot.dead_zone) all.push_back(width);
  for (const std::vector<double>& v :
       {c.patient.breathing.tissue, c.patient.breathing.trocar, c.patient.drift, c.patient.jump}) {
    all.insert(all.end(), v.begin(), v.end());
  }
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
  EXPECT_EQ(config.shaft, ControllerNodeConfig().shaft);
  EXPECT_EQ(config.owners.task_error, InputOwners().task_error);
  EXPECT_EQ(config.owners.operating_state, InputOwners().operating_state);
  EXPECT_EQ(config.owners.manual, InputOwners().manual);
  EXPECT_EQ(config.owners.dead_man, InputOwners().dead_man);
  EXPECT_EQ(config.frame_prefix, ControllerNodeConfig().frame_prefix);
  EXPECT_EQ(config.tf_owner, ControllerNodeConfig().tf_owner);
  EXPECT_EQ(config.external_stops.stop_line.path, "");
  EXPECT_EQ(config.external_stops.stop_line.signal, "");
  // Lists are one leaf; three frames and their prefix, five owners, two texts of the stop line.
  EXPECT_EQ(leaves(tree), numbers(config).size() - 2 * 2 + 4 + 5 + 2);
}

TEST(ControllerParameters, FileOfTheSimulationEqualsTheDefaults) {
  const XmlRpc::XmlRpcValue tree = parametersFromYaml(kConfig + "/simulate_servo.yaml");
  ParameterReader reader(tree, "");
  const closed_loop::SimulationConfig config = simulationConfig(reader);
  reader.refuseUnknown("");
  EXPECT_EQ(reader.report(), "");
  EXPECT_EQ(numbers(config), numbers(closed_loop::SimulationConfig()));
  EXPECT_EQ(config.robot.dead_zone_kind, closed_loop::SimulationConfig().robot.dead_zone_kind);
  EXPECT_EQ(leaves(tree), numbers(config).size() - 3 - 4 * 2 + 3);  // lists are one leaf; and two words, four signs
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
        value = number == 0.0 ? 0.11 : number * 1.0625;
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
  EXPECT_EQ(changed, 105);
}

TEST(ControllerParameters, NothingSetGivesTheDefaults) {
  ParameterReader reader(XmlRpc::XmlRpcValue(), "/controller");
  EXPECT_EQ(numbers(controllerNodeConfig(reader)), numbers(ControllerNodeConfig()));
  EXPECT_EQ(reader.report(), "");
}

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
}  // namespace laparoscope_servo
