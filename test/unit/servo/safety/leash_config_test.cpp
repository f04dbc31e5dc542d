#include "laparoscope_servo/servo/leash_config.h"

#include <gtest/gtest.h>

#include "support/config_check.h"

namespace laparoscope_servo::servo {
namespace {

using Config = LeashConfig;

TEST(LeashConfig, TheDefaultsAreValid) {
  EXPECT_TRUE(parameters::errorsOf(Config()).empty());
}

TEST(LeashConfig, ParametersAreTheFieldsOfTheirNames) {
  test_support::expectRowsAreFields<Config>({{"turn", &Config::turn},
                                             {"spin", &Config::spin},
                                             {"insertion", &Config::insertion},
                                             {"quick_insertion", &Config::quick_insertion},
                                             {"quick_time", &Config::quick_time},
                                             {"approach", &Config::approach}});
}

// A leash without length would stop the scope at once, and a mean over no time is that of one image.
TEST(LeashConfig, NoLengthIsZeroButTheShareOnTheWayMayBe) {
  Config config;
  config.turn = config.spin = config.insertion = config.quick_insertion = config.quick_time = config.approach = 0.0;
  const std::vector<std::string> errors = parameters::errorsOf(config);
  EXPECT_EQ(errors.size(), 5u);
  EXPECT_FALSE(test_support::names(errors, "approach"));
}

// But not while the node runs: it is one of the limits of safety.
TEST(LeashConfig, MayBeSwitchedOff) {
  Config config;
  parameters::Table table;
  describe(table, config);
  EXPECT_EQ(table.find("enabled")->take(false), "");
  EXPECT_FALSE(config.enabled);
  for (const parameters::Row& row : table.rows()) EXPECT_FALSE(row.while_running) << row.name << " is of the safety";
}

}  // namespace
}  // namespace laparoscope_servo::servo
