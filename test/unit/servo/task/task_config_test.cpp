#include "laparoscope_servo/servo/task_config.h"

#include <gtest/gtest.h>

#include "support/config_check.h"

namespace laparoscope_servo::servo {
namespace {

using test_support::expectRowsAreFields;
using test_support::names;

TEST(TaskConfig, TheDefaultsAreValid) {
  EXPECT_TRUE(parameters::errorsOf(StabiliseConfig()).empty());
  EXPECT_TRUE(parameters::errorsOf(CentreTipConfig()).empty());
  EXPECT_TRUE(parameters::errorsOf(FollowConfig()).empty());
  EXPECT_TRUE(parameters::errorsOf(PointsConfig()).empty());
  EXPECT_TRUE(parameters::errorsOf(ParallelConfig()).empty());
}

TEST(TaskConfig, ParametersAreTheFieldsOfTheirNames) {
  expectRowsAreFields<StabiliseConfig>({{"max_error", &StabiliseConfig::max_error}});
  expectRowsAreFields<CentreTipConfig>({{"x", &CentreTipConfig::x},
                                        {"y", &CentreTipConfig::y},
                                        {"inner", &CentreTipConfig::inner},
                                        {"zone", &CentreTipConfig::zone},
                                        {"leave", &CentreTipConfig::leave},
                                        {"dwell", &CentreTipConfig::dwell},
                                        {"still", &CentreTipConfig::still},
                                        {"max_error", &CentreTipConfig::max_error}});
  expectRowsAreFields<FollowConfig>(
      {{"x", &FollowConfig::x}, {"y", &FollowConfig::y}, {"max_error", &FollowConfig::max_error}});
  expectRowsAreFields<PointsConfig>({{"min_points", &PointsConfig::min_points},
                                     {"min_noise", &PointsConfig::min_noise},
                                     {"max_error", &PointsConfig::max_error}});
  expectRowsAreFields<ParallelConfig>({{"radius", &ParallelConfig::radius},
                                       {"period", &ParallelConfig::period},
                                       {"turns", &ParallelConfig::turns},
                                       {"stddev", &ParallelConfig::stddev},
                                       {"max_error", &ParallelConfig::max_error},
                                       {"max_turn", &ParallelConfig::max_turn},
                                       {"min_distance", &ParallelConfig::min_distance},
                                       {"max_change", &ParallelConfig::max_change},
                                       {"keep", &ParallelConfig::keep}});
}

TEST(TaskConfig, StabiliseTellsSpinFromInsertion) {
  StabiliseConfig config;
  parameters::Table table;
  describe(table, config);
  EXPECT_EQ(table.find("spin")->take(true), "");
  EXPECT_TRUE(config.spin);
  EXPECT_FALSE(config.insertion);
  EXPECT_EQ(table.find("insertion")->take(true), "");
  EXPECT_TRUE(config.insertion);
}

// inner <= zone <= leave.
TEST(TaskConfig, TheZonesOfATipLieWithinEachOther) {
  CentreTipConfig config;
  config.inner = config.zone = config.leave = 0.3;
  EXPECT_TRUE(parameters::errorsOf(config).empty());
  config.zone = 0.29;
  EXPECT_EQ(parameters::errorsOf(config), std::vector<std::string>{"zone = 0.29, expected at least inner = 0.3"});
  config.inner = 0.1;
  config.leave = 0.28;
  EXPECT_EQ(parameters::errorsOf(config), std::vector<std::string>{"leave = 0.28, expected at least zone = 0.29"});
}

// With two points the motion is determined, and no wrong one shows; a noise of zero has no robust scale.
TEST(TaskConfig, PointsNeedOneToSpareAndANoise) {
  PointsConfig config;
  config.min_points = 3;
  EXPECT_TRUE(parameters::errorsOf(config).empty());
  config.min_points = 2;
  config.min_noise = 0.0;
  EXPECT_EQ(parameters::errorsOf(config).size(), 2u);
  EXPECT_TRUE(names(parameters::errorsOf(config), "min_points"));
  EXPECT_TRUE(names(parameters::errorsOf(config), "min_noise"));
}

// The scope does not turn onto tissue that it would touch, and no further than the optics see it.
TEST(TaskConfig, ParallelKeepsADistanceAndIsNoFullTurn) {
  ParallelConfig config;
  config.min_distance = 0.0;
  config.max_turn = 0.9;
  EXPECT_EQ(parameters::errorsOf(config),
            (std::vector<std::string>{"max_turn = 0.9, expected a number in [0.01, 0.8] rad",
                                      "min_distance = 0, expected a number in [0.005, 0.5] m"}));
}

}  // namespace
}  // namespace laparoscope_servo::servo
