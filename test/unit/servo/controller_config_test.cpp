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
                                  const std::function<scope::Velocity&(ControllerConfig&)>& group) {
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
      {"features/centre", [](ControllerConfig& c, double v) { c.features.centre = v; }},
      {"features/depth", [](ControllerConfig& c, double v) { c.features.depth = v; }},
      {"features/orientation", [](ControllerConfig& c, double v) { c.features.orientation = v; }},
      {"features/desired_depth", [](ControllerConfig& c, double v) { c.features.desired_depth = v; }},
      {"predictor/delay", [](ControllerConfig& c, double v) { c.predictor.delay = v; }},
      {"predictor/min_delay", [](ControllerConfig& c, double v) { c.predictor.min_delay = v; }},
      {"predictor/max_delay", [](ControllerConfig& c, double v) { c.predictor.max_delay = v; }},
      {"breathing/rate", [](ControllerConfig& c, double v) { c.breathing.rate = v; }},
      {"breathing/rate_stddev", [](ControllerConfig& c, double v) { c.breathing.rate_stddev = v; }},
      {"breathing/min_rate", [](ControllerConfig& c, double v) { c.breathing.filter.min_frequency = v; }},
      {"breathing/max_rate", [](ControllerConfig& c, double v) { c.breathing.filter.max_frequency = v; }},
      {"range/min_depth", [](ControllerConfig& c, double v) { c.range.min_depth = v; }},
      {"range/max_depth", [](ControllerConfig& c, double v) { c.range.max_depth = v; }},
      {"range/depth_margin", [](ControllerConfig& c, double v) { c.range.depth_margin = v; }},
      {"range/cone", [](ControllerConfig& c, double v) { c.range.cone = v; }},
      {"range/cone_margin", [](ControllerConfig& c, double v) { c.range.cone_margin = v; }},
      {"insertion_point/prior_stddev", [](ControllerConfig& c, double v) { c.insertion_point.prior_stddev = v; }},
      {"insertion_point/wobble", [](ControllerConfig& c, double v) { c.insertion_point.estimator.wobble = v; }},
      {"insertion_point/warning_residual",
       [](ControllerConfig& c, double v) { c.insertion_point.estimator.warning_residual = v; }},
      {"insertion_point/stop_residual",
       [](ControllerConfig& c, double v) { c.insertion_point.estimator.stop_residual = v; }},
      {"target/centre_noise", [](ControllerConfig& c, double v) { c.target.centre_noise = v; }},
      {"target/depth_noise", [](ControllerConfig& c, double v) { c.target.depth_noise = v; }},
      {"target/orientation_noise", [](ControllerConfig& c, double v) { c.target.orientation_noise = v; }},
      {"target/centre_wander", [](ControllerConfig& c, double v) { c.target.centre_wander = v; }},
      {"target/depth_wander", [](ControllerConfig& c, double v) { c.target.depth_wander = v; }},
      {"target/orientation_wander", [](ControllerConfig& c, double v) { c.target.orientation_wander = v; }},
      {"target/centre_acceleration", [](ControllerConfig& c, double v) { c.target.centre_acceleration = v; }},
      {"target/depth_acceleration", [](ControllerConfig& c, double v) { c.target.depth_acceleration = v; }},
      {"target/orientation_acceleration", [](ControllerConfig& c, double v) { c.target.orientation_acceleration = v; }},
      {"target/calibration", [](ControllerConfig& c, double v) { c.target.calibration = v; }},
      {"target/significance", [](ControllerConfig& c, double v) { c.target.significance = v; }},
      {"target/jump", [](ControllerConfig& c, double v) { c.target.jump = v; }},
      {"target/damping", [](ControllerConfig& c, double v) { c.target.damping = v; }},
      {"rest/centre_stop", [](ControllerConfig& c, double v) { c.rest.centre_stop = v; }},
      {"rest/centre_start", [](ControllerConfig& c, double v) { c.rest.centre_start = v; }},
      {"rest/depth_stop", [](ControllerConfig& c, double v) { c.rest.depth_stop = v; }},
      {"rest/depth_start", [](ControllerConfig& c, double v) { c.rest.depth_start = v; }},
      {"rest/orientation_stop", [](ControllerConfig& c, double v) { c.rest.orientation_stop = v; }},
      {"rest/orientation_start", [](ControllerConfig& c, double v) { c.rest.orientation_start = v; }},
      {"rest/hunting_time", [](ControllerConfig& c, double v) { c.rest.hunting_time = v; }},
      {"rest/widening", [](ControllerConfig& c, double v) { c.rest.widening = v; }},
      {"rest/widest", [](ControllerConfig& c, double v) { c.rest.widest = v; }},
      {"effect/tissue_centre", [](ControllerConfig& c, double v) { c.effect.tissue_centre = v; }},
      {"effect/tissue_depth", [](ControllerConfig& c, double v) { c.effect.tissue_depth = v; }},
      {"effect/tissue_orientation", [](ControllerConfig& c, double v) { c.effect.tissue_orientation = v; }},
      {"effect/tissue_time", [](ControllerConfig& c, double v) { c.effect.tissue_time = v; }},
      {"effect/unrest_time", [](ControllerConfig& c, double v) { c.effect.unrest_time = v; }},
      {"effect/memory", [](ControllerConfig& c, double v) { c.effect.memory = v; }},
      {"effect/doubt", [](ControllerConfig& c, double v) { c.effect.doubt = v; }},
      {"effect/release", [](ControllerConfig& c, double v) { c.effect.release = v; }},
      {"effect/certain", [](ControllerConfig& c, double v) { c.effect.certain = v; }},
      {"effect/standing_time", [](ControllerConfig& c, double v) { c.effect.standing_time = v; }},
      {"effect/unconfirmed_turn", [](ControllerConfig& c, double v) { c.effect.unconfirmed_turn = v; }},
      {"effect/unconfirmed_insertion", [](ControllerConfig& c, double v) { c.effect.unconfirmed_insertion = v; }},
      {"oscillation/half_period", [](ControllerConfig& c, double v) { c.oscillation.half_period = v; }},
      {"oscillation/centre", [](ControllerConfig& c, double v) { c.oscillation.centre = v; }},
      {"oscillation/depth", [](ControllerConfig& c, double v) { c.oscillation.depth = v; }},
      {"oscillation/orientation", [](ControllerConfig& c, double v) { c.oscillation.orientation = v; }},
      {"oscillation/step", [](ControllerConfig& c, double v) { c.oscillation.step = v; }},
      {"oscillation/least", [](ControllerConfig& c, double v) { c.oscillation.least = v; }},
      {"safety/max_task_error_age", [](ControllerConfig& c, double v) { c.safety.max_task_error_age = v; }},
      {"safety/slow_age", [](ControllerConfig& c, double v) { c.safety.slow_age = v; }},
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
      {"safety/max_tip_speed", [](ControllerConfig& c, double v) { c.safety.max_tip_speed = v; }},
      {"safety/max_tip_turn", [](ControllerConfig& c, double v) { c.safety.max_tip_turn = v; }},
      {"safety/max_optics_offset", [](ControllerConfig& c, double v) { c.safety.max_optics_offset = v; }},
      {"safety/max_manual_age", [](ControllerConfig& c, double v) { c.safety.max_manual_age = v; }},
      {"safety/max_dead_man_age", [](ControllerConfig& c, double v) { c.safety.max_dead_man_age = v; }},
      {"safety/max_robot_state_age", [](ControllerConfig& c, double v) { c.safety.max_robot_state_age = v; }}};
  const auto add = [&all](const std::vector<Field>& more) { all.insert(all.end(), more.begin(), more.end()); };
  add(velocityFields("dead_zone/width", [](ControllerConfig& c) -> scope::Velocity& { return c.dead_zone.width; }));
  add(velocityFields("limits/velocity", [](ControllerConfig& c) -> scope::Velocity& { return c.limits.velocity; }));
  add(velocityFields("limits/acceleration",
                     [](ControllerConfig& c) -> scope::Velocity& { return c.limits.acceleration; }));
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
  config.rest.centre_stop = 0.02;
  config.rest.centre_start = 0.01;
  EXPECT_TRUE(names(validate(config), "rest/centre_start"));
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

TEST(ControllerConfig, DirectionsNeedALength) {
  ControllerConfig config;
  config.range.axis = {0.0, 0.0, 0.0};
  config.horizon.up = {0.0, std::numeric_limits<double>::quiet_NaN(), 1.0};
  const std::vector<std::string> errors = validate(config);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(errors[0], "horizon/up[1] = nan, expected a list of 3 numbers");
  EXPECT_EQ(errors[1], "range/axis is no direction, expected numbers that are not all zero");
}

TEST(ControllerConfig, TheInverseOfTheDeadZoneHasToFitIntoTheLimits) {
  ControllerConfig config;
  config.limits.velocity.insertion = config.dead_zone.width.insertion;
  ASSERT_EQ(validate(config).size(), 1u);
  EXPECT_EQ(validate(config)[0].rfind("limits/velocity", 0), 0u);
  config.dead_zone.inverse = false;
  EXPECT_TRUE(validate(config).empty());
}

}  // namespace
}  // namespace laparoscope_servo::servo
