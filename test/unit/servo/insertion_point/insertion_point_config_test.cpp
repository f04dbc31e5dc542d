#include "laparoscope_servo/servo/insertion_point_config.h"

#include <gtest/gtest.h>

#include "support/config_check.h"

namespace laparoscope_servo::servo {
namespace {

using Config = InsertionPointConfig;
using Field = test_support::NumberField<Config>;

std::vector<std::string> errorsOf(const Config& config) {
  return validate(config);
}

TEST(InsertionPointConfig, TheDefaultsAreValid) {
  EXPECT_TRUE(validate(Config()).empty());
}

TEST(InsertionPointConfig, ParametersAreTheFieldsOfTheirNames) {
  test_support::expectRowsAreFields<Config>({{"wobble", &Config::wobble},
                                             {"warning_residual", &Config::warning_residual},
                                             {"stop_residual", &Config::stop_residual}});
}

TEST(InsertionPointConfig, EachNumberHasItsRange) {
  using test_support::expectRange;
  const Config usual;
  expectRange(Field("wobble", &Config::wobble), 0.0, 0.05, errorsOf);
  expectRange(Field("warning_residual", &Config::warning_residual), 1e-4, 0.1, errorsOf);
  expectRange(Field("stop_residual", &Config::stop_residual), usual.warning_residual, 0.1, errorsOf);
  expectRange(Field("direction_noise", &Config::direction_noise), 0.0, 0.1, errorsOf);
  expectRange(Field("drift", &Config::drift), 0.0, 0.01, errorsOf);
  expectRange(Field("same_direction", &Config::same_direction), 0.0, 0.5, errorsOf);
  expectRange(Field("samples_per_direction", &Config::samples_per_direction), 1, 1000, errorsOf);
  expectRange(Field("max_samples", &Config::max_samples), 10, 10000, errorsOf);
  expectRange(Field("min_samples", &Config::min_samples), 3, usual.max_samples, errorsOf);
  expectRange(Field("min_eigenvalue", &Config::min_eigenvalue), 1e-6, 0.5, errorsOf);
  expectRange(Field("residual_samples", &Config::residual_samples), 1, 1000, errorsOf);
  expectRange(Field("residual_hysteresis", &Config::residual_hysteresis), 0.0, 0.9, errorsOf);
}

// A pose without noise would have an infinite weight.
TEST(InsertionPointConfig, PosesHaveNoise) {
  test_support::expectRange(Field("position_noise", &Config::position_noise), 1e-6, 0.05, errorsOf);
}

TEST(InsertionPointConfig, AStopComesNoEarlierThanItsWarning) {
  Config config;
  config.warning_residual = 0.02;
  EXPECT_EQ(validate(config),
            std::vector<std::string>{"stop_residual = 0.012, expected at least warning_residual = 0.02"});
}

// Otherwise there would never be an estimate. Where max_samples is wrong itself, only that is said.
TEST(InsertionPointConfig, NoMorePosesAreNeededThanAreKept) {
  Config config;
  config.max_samples = 20;
  config.min_samples = 21;
  EXPECT_EQ(validate(config), std::vector<std::string>{"min_samples = 21, expected a number in [3, 20]"});
  config.max_samples = -5;
  config.min_samples = 3;
  EXPECT_EQ(validate(config), std::vector<std::string>{"max_samples = -5, expected a number in [10, 10000]"});
}

}  // namespace
}  // namespace laparoscope_servo::servo
