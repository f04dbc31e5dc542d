#include <gtest/gtest.h>

#include "laparoscope_servo/features/points.h"
#include "support/config_check.h"

namespace laparoscope_servo::features {
namespace {

using Config = PointsConfig;
using test_support::names;

TEST(PointsConfig, TheDefaultsAreValid) {
  EXPECT_TRUE(validate(Config()).empty());
}

TEST(PointsConfig, ParametersAreTheFieldsOfTheirNames) {
  using Field = test_support::NumberField<Config>;
  const std::vector<Field> fields{{"window", &Config::window},
                                  {"levels", &Config::levels},
                                  {"corner_quality", &Config::corner_quality},
                                  {"min_distance", &Config::min_distance},
                                  {"saturation", &Config::saturation},
                                  {"min_correlation", &Config::min_correlation},
                                  {"min_share", &Config::min_share},
                                  {"max_error", &Config::max_error},
                                  {"max_scale", &Config::max_scale},
                                  {"max_distortion", &Config::max_distortion},
                                  {"search_range", &Config::search_range},
                                  {"recall_period", &Config::recall_period}};
  test_support::expectRowsAreFields<Config>(fields, 2);  // and two of the state
}

// A window has a middle pixel.
TEST(PointsConfig, AWindowIsOdd) {
  for (int window = 8; window <= 62; ++window) {
    Config config;
    config.window = window;
    EXPECT_EQ(validate(config).empty(), window % 2 == 1 && window >= 9 && window <= 61) << window;
  }
  Config config;
  config.window = 20;
  EXPECT_EQ(validate(config), std::vector<std::string>{"window = 20, expected an odd number"});
}

TEST(PointsConfig, EachErrorNamesItsField) {
  Config config;
  config.levels = 0;
  config.max_scale = 0.5;
  config.min_share = std::nan("");
  config.state.confirmations = 0;
  const std::vector<std::string> errors = validate(config);
  EXPECT_EQ(errors.size(), 4u);
  for (const char* const name : {"levels", "max_scale", "min_share", "confirmations"})
    EXPECT_TRUE(names(errors, name)) << name;
}

}  // namespace
}  // namespace laparoscope_servo::features
