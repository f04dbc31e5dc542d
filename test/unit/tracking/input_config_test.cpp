#include "laparoscope_servo/tracking/input_config.h"

#include <gtest/gtest.h>

#include "support/config_check.h"

namespace laparoscope_servo::tracking {
namespace {

using Config = InputConfig;

TEST(InputConfig, TheDefaultsAreValid) {
  EXPECT_TRUE(validate(Config()).empty());
}

TEST(InputConfig, ParametersAreTheFieldsOfTheirNames) {
  test_support::expectRowsAreFields<Config>({{"max_repeats", &Config::max_repeats},
                                             {"max_still_repeats", &Config::max_still_repeats},
                                             {"moving", &Config::moving},
                                             {"moved", &Config::moved},
                                             {"restart_images", &Config::restart_images},
                                             {"loop_step", &Config::loop_step},
                                             {"max_gap", &Config::max_gap},
                                             {"max_ahead", &Config::max_ahead}});
}

// One image alone may be wrong: a new time or size needs a second one. A picture counts as moved beyond noise only.
TEST(InputConfig, OneImageProvesNothing) {
  Config config;
  config.restart_images = 1;
  config.moving = config.moved = config.loop_step = config.max_gap = 0.0;
  const std::vector<std::string> errors = validate(config);
  EXPECT_EQ(errors.size(), 5u);
  EXPECT_TRUE(test_support::names(errors, "restart_images"));
  config = Config();
  config.max_repeats = config.max_still_repeats = 0;
  config.max_ahead = 0.0;
  EXPECT_TRUE(validate(config).empty()) << "none may repeat, and clocks may be asked to be equal";
}

// What every tracker has, and nothing else; the words are those of the tracker.
TEST(InputConfig, TrackersOfFeaturesHaveTheSequenceAlone) {
  Config config;
  parameters::Table table;
  describeSequence(table, config, "what is done then");
  EXPECT_EQ(table.names(), (std::set<std::string>{"restart_images", "loop_step", "max_gap", "max_ahead"}));
  EXPECT_NE(table.find("loop_step")->meaning.find("what is done then"), std::string::npos);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
