#include "laparoscope_servo/servo/safety_config.h"

#include <gtest/gtest.h>

#include "support/config_check.h"

namespace laparoscope_servo::servo {
namespace {

using Config = SafetyConfig;
using test_support::names;

TEST(SafetyConfig, TheDefaultsAreValid) {
  EXPECT_TRUE(parameters::errorsOf(Config()).empty());
}

TEST(SafetyConfig, ParametersAreTheFieldsOfTheirNames) {
  test_support::expectRowsAreFields<Config>({
      {"max_task_error_age", &Config::max_task_error_age},
      {"slow_age", &Config::slow_age},
      {"max_depth_age", &Config::max_depth_age},
      {"resume_time", &Config::resume_time},
      {"max_period", &Config::max_period},
      {"max_clock_step", &Config::max_clock_step},
      {"max_dead_man_age", &Config::max_dead_man_age},
      {"max_robot_state_age", &Config::max_robot_state_age},
      {"max_manual_age", &Config::max_manual_age},
      {"max_manual_repeat", &Config::max_manual_repeat},
      {"max_clock_difference", &Config::max_clock_difference},
      {"min_depth", &Config::min_depth},
      {"max_depth", &Config::max_depth},
      {"max_lateral_offset", &Config::max_lateral_offset},
      {"max_tip_speed", &Config::max_tip_speed},
      {"max_tip_turn", &Config::max_tip_turn},
      {"max_optics_offset", &Config::max_optics_offset},
      {"slow_below", &Config::slow_below},
      {"hold_below", &Config::hold_below},
      {"release_hold_above", &Config::release_hold_above},
      {"min_visible_for_insertion", &Config::min_visible_for_insertion},
      {"max_corner_error_for_insertion", &Config::max_corner_error_for_insertion},
      {"max_repeated_errors", &Config::max_repeated_errors},
      {"manual_neutral", &Config::manual_neutral},
  });
}

TEST(SafetyConfig, SwitchesAreTheFieldsOfTheirNames) {
  Config config;
  parameters::Table table;
  describe(table, config);
  EXPECT_EQ(table.find("dead_man_required")->take(true), "");
  EXPECT_TRUE(config.dead_man_required);
  EXPECT_TRUE(config.robot_required);
  EXPECT_EQ(table.find("robot_required")->take(false), "");
  EXPECT_FALSE(config.robot_required);
}

// No age may be endless: what is silent has to be noticed within 1 s, the arm within 2 s.
TEST(SafetyConfig, WhatIsSilentIsNoticedSoon) {
  Config config;
  config.max_task_error_age = config.max_depth_age = config.max_dead_man_age = config.max_manual_age = 1.01;
  config.max_robot_state_age = 2.01;
  const std::vector<std::string> errors = parameters::errorsOf(config);
  EXPECT_EQ(errors.size(), 5u);
  for (const char* const name :
       {"max_task_error_age", "max_depth_age", "max_dead_man_age", "max_manual_age", "max_robot_state_age"})
    EXPECT_TRUE(names(errors, name)) << name;
}

TEST(SafetyConfig, ThresholdsAreInOrder) {
  Config config;
  config.hold_below = config.slow_below = config.release_hold_above = 0.3;
  EXPECT_TRUE(parameters::errorsOf(config).empty());
  config.hold_below = 0.4;
  EXPECT_TRUE(names(parameters::errorsOf(config), "slow_below"));
  EXPECT_TRUE(names(parameters::errorsOf(config), "release_hold_above"));
  config = Config();
  config.max_depth = 0.5 * config.min_depth;
  EXPECT_TRUE(names(parameters::errorsOf(config), "max_depth"));
  config = Config();
  config.max_clock_step = 0.5 * config.max_period;
  EXPECT_TRUE(names(parameters::errorsOf(config), "max_clock_step"));
}

TEST(SafetyConfig, NoneOfItChangesWhileTheNodeRuns) {
  Config config;
  parameters::Table table;
  describe(table, config);
  for (const parameters::Row& row : table.rows()) EXPECT_FALSE(row.while_running) << row.name;
}

}  // namespace
}  // namespace laparoscope_servo::servo
