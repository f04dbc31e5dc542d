#include "laparoscope_servo/features/edge_config.h"

#include <gtest/gtest.h>

#include "support/config_check.h"

namespace laparoscope_servo::features {
namespace {

using Config = EdgeConfig;
using test_support::names;

TEST(EdgeConfig, TheDefaultsAreValid) {
  EXPECT_TRUE(validate(Config()).empty());
}

TEST(EdgeConfig, ParametersAreTheFieldsOfTheirNames) {
  const auto search_time = [](Config& c) -> double& { return c.state.max_search_time; };
  Config config;
  parameters::Table table;
  describe(table, config);
  ASSERT_NE(table.find("confirmations"), nullptr) << "of the state";
  EXPECT_EQ(table.find("confirmations")->take(7), "");
  EXPECT_EQ(config.state.confirmations, 7);
  using Field = test_support::NumberField<Config>;
  const std::vector<Field> fields{{"spacing", &Config::spacing},
                                  {"max_sites", &Config::max_sites},
                                  {"range", &Config::range},
                                  {"min_contrast", &Config::min_contrast},
                                  {"min_similarity", &Config::min_similarity},
                                  {"min_share", &Config::min_share},
                                  {"min_return_share", &Config::min_return_share},
                                  {"max_error", &Config::max_error},
                                  {"max_change", &Config::max_change},
                                  {"velocity_damping", &Config::velocity_damping},
                                  {"max_search_time", search_time}};
  test_support::expectRowsAreFields<Config>(fields, 1);
}

// Fewer than 16 sites do not tell a curve from chance, nor does a search within the blur of an edge.
TEST(EdgeConfig, ACurveHasEnoughToBeTold) {
  Config config;
  config.max_sites = 15;
  config.range = 5.9;
  config.min_share = config.min_return_share = config.min_similarity = 0.0;
  const std::vector<std::string> errors = validate(config);
  EXPECT_EQ(errors.size(), 5u);
  for (const char* const name : {"max_sites", "range", "min_share", "min_return_share", "min_similarity"})
    EXPECT_TRUE(names(errors, name)) << name;
}

TEST(EdgeConfig, ErrorsOfTheStateAreNamedToo) {
  Config config;
  config.state.confirmations = 0;
  config.velocity_damping = std::nan("");
  EXPECT_TRUE(names(validate(config), "confirmations"));
  EXPECT_TRUE(names(validate(config), "velocity_damping"));
}

}  // namespace
}  // namespace laparoscope_servo::features
