#include "laparoscope_servo/servo/controller_config.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace laparoscope_servo::servo {
namespace {

using Change = std::function<void(ControllerConfig&, double)>;

struct Field {
  std::string name;
  Change set;
};

std::vector<Field> velocityFields(const std::string& name,
                                  const std::function<ScopeVelocity&(ControllerConfig&)>& group) {
  return {{name + "/pan", [=](ControllerConfig& c, double v) { group(c).pan = v; }},
          {name + "/tilt", [=](ControllerConfig& c, double v) { group(c).tilt = v; }},
          {name + "/spin", [=](ControllerConfig& c, double v) { group(c).spin = v; }},
          {name + "/insertion", [=](ControllerConfig& c, double v) { group(c).insertion = v; }}};
}

std::vector<Field> fields() {
  std::vector<Field> all{
      {"gains/pan", [](ControllerConfig& c, double v) { c.gains.pan = v; }},
      {"gains/tilt", [](ControllerConfig& c, double v) { c.gains.tilt = v; }},
      {"gains/spin", [](ControllerConfig& c, double v) { c.gains.spin = v; }},
      {"gains/insertion", [](ControllerConfig& c, double v) { c.gains.insertion = v; }},
      {"safety/max_task_error_age", [](ControllerConfig& c, double v) { c.safety.max_task_error_age = v; }},
      {"safety/max_depth_age", [](ControllerConfig& c, double v) { c.safety.max_depth_age = v; }},
      {"safety/min_depth", [](ControllerConfig& c, double v) { c.safety.min_depth = v; }},
      {"safety/max_depth", [](ControllerConfig& c, double v) { c.safety.max_depth = v; }},
      {"safety/max_lateral_offset", [](ControllerConfig& c, double v) { c.safety.max_lateral_offset = v; }},
      {"safety/resume_time", [](ControllerConfig& c, double v) { c.safety.resume_time = v; }},
      {"safety/max_period", [](ControllerConfig& c, double v) { c.safety.max_period = v; }},
      {"safety/max_clock_step", [](ControllerConfig& c, double v) { c.safety.max_clock_step = v; }},
      {"safety/slow_below", [](ControllerConfig& c, double v) { c.safety.slow_below = v; }},
      {"safety/hold_below", [](ControllerConfig& c, double v) { c.safety.hold_below = v; }},
      {"safety/release_hold_above", [](ControllerConfig& c, double v) { c.safety.release_hold_above = v; }},
      {"safety/min_visible_for_insertion",
       [](ControllerConfig& c, double v) { c.safety.min_visible_for_insertion = v; }},
      {"safety/max_corner_error_for_insertion",
       [](ControllerConfig& c, double v) { c.safety.max_corner_error_for_insertion = v; }},
      {"safety/max_dead_man_age", [](ControllerConfig& c, double v) { c.safety.max_dead_man_age = v; }},
      {"safety/max_robot_state_age", [](ControllerConfig& c, double v) { c.safety.max_robot_state_age = v; }}};
  const auto add = [&all](const std::vector<Field>& more) { all.insert(all.end(), more.begin(), more.end()); };
  add(velocityFields("dead_zone/width", [](ControllerConfig& c) -> ScopeVelocity& { return c.dead_zone.width; }));
  add(velocityFields("dead_zone/stop", [](ControllerConfig& c) -> ScopeVelocity& { return c.dead_zone.stop; }));
  add(velocityFields("dead_zone/start", [](ControllerConfig& c) -> ScopeVelocity& { return c.dead_zone.start; }));
  add(velocityFields("limits/velocity", [](ControllerConfig& c) -> ScopeVelocity& { return c.limits.velocity; }));
  add(velocityFields("limits/acceleration",
                     [](ControllerConfig& c) -> ScopeVelocity& { return c.limits.acceleration; }));
  return all;
}

bool names(const std::vector<std::string>& errors, const std::string& name) {
  for (const std::string& error : errors) {
    if (error.rfind(name + " = ", 0) == 0) return true;
  }
  return false;
}

TEST(ControllerConfig, DefaultsAreValid) {
  EXPECT_TRUE(validate(ControllerConfig()).empty());
}

TEST(ControllerConfig, NamesEachFieldThatIsOutOfRange) {
  const double bad[] = {-1.0, 1e6, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
  for (const Field& field : fields()) {
    for (const double value : bad) {
      ControllerConfig config;
      field.set(config, value);
      EXPECT_TRUE(names(validate(config), field.name)) << field.name << " = " << value;
    }
  }
}

TEST(ControllerConfig, NamesAllErrorsAtOnce) {
  ControllerConfig config;
  for (const Field& field : fields()) field.set(config, -1.0);
  const std::vector<std::string> errors = validate(config);
  for (const Field& field : fields()) EXPECT_TRUE(names(errors, field.name)) << field.name;
}

TEST(ControllerConfig, ThresholdsHaveToBeInOrder) {
  ControllerConfig config;
  config.dead_zone.stop.spin = 0.02;
  config.dead_zone.start.spin = 0.01;
  EXPECT_TRUE(names(validate(config), "dead_zone/start/spin"));
  config = ControllerConfig();
  config.safety.min_depth = 0.2;
  config.safety.max_depth = 0.1;
  EXPECT_TRUE(names(validate(config), "safety/max_depth"));
  config = ControllerConfig();
  config.safety.hold_below = 0.6;
  EXPECT_TRUE(names(validate(config), "safety/slow_below"));
  EXPECT_TRUE(names(validate(config), "safety/release_hold_above"));
  config = ControllerConfig();
  config.safety.max_clock_step = 0.05;
  EXPECT_TRUE(names(validate(config), "safety/max_clock_step"));
}

// Since components are scaled together, a velocity limit of zero would stop all of them.
TEST(ControllerConfig, RefusesALimitOfZero) {
  ControllerConfig config;
  config.limits.velocity.spin = 0.0;
  EXPECT_TRUE(names(validate(config), "limits/velocity/spin"));
  config = ControllerConfig();
  config.gains.spin = 0.0;
  EXPECT_TRUE(validate(config).empty());
}

}  // namespace
}  // namespace laparoscope_servo::servo
