#include "servo/prediction/delay_config.h"

#include <gtest/gtest.h>

#include "support/config_check.h"

namespace laparoscope_servo::servo {
namespace {

using Field = test_support::NumberField<DelayConfig>;

std::vector<std::string> errorsOf(const DelayConfig& config) {
  return validate(config);
}

TEST(DelayConfig, TheDefaultsAreValid) {
  EXPECT_TRUE(validate(DelayConfig()).empty());
}

TEST(DelayConfig, EachNumberHasItsRange) {
  using test_support::expectRange;
  const DelayConfig usual;
  expectRange(Field("minimum", &DelayConfig::minimum), 0.0, 1.0, errorsOf);
  expectRange(Field("maximum", &DelayConfig::maximum), usual.minimum, 1.0, errorsOf);
  expectRange(Field("initial", &DelayConfig::initial), usual.minimum, usual.maximum, errorsOf);
  expectRange(Field("lag", &DelayConfig::lag), 0.0, 1.0, errorsOf);
  expectRange(Field("window", &DelayConfig::window), 1.0, 60.0, errorsOf);
  expectRange(Field("period", &DelayConfig::period), 0.01, 10.0, errorsOf);
  expectRange(Field("step", &DelayConfig::step), 0.002, 0.1, errorsOf);
  expectRange(Field("max_rate", &DelayConfig::max_rate), 0.0, 1.0, errorsOf);
  expectRange(Field("max_gap", &DelayConfig::max_gap), 0.05, 10.0, errorsOf);
  expectRange(Field("min_correlation", &DelayConfig::min_correlation), 0.1, 1.0, errorsOf);
  expectRange(Field("max_stddev", &DelayConfig::max_stddev), 1e-4, 0.2, errorsOf);
}

// With an excitation of zero the noise of a scope at rest would count as a command, and give a delay.
TEST(DelayConfig, EachAxisNeedsAnExcitation) {
  using test_support::expectRange;
  const auto axis = [](double scope::Velocity::*member) {
    return [member](DelayConfig& c) -> double& { return c.min_excitation.*member; };
  };
  expectRange(Field("min_excitation/pan", axis(&scope::Velocity::pan)), 1e-5, 1.0, errorsOf);
  expectRange(Field("min_excitation/tilt", axis(&scope::Velocity::tilt)), 1e-5, 1.0, errorsOf);
  expectRange(Field("min_excitation/spin", axis(&scope::Velocity::spin)), 1e-5, 1.0, errorsOf);
  expectRange(Field("min_excitation/insertion", axis(&scope::Velocity::insertion)), 1e-6, 0.1, errorsOf);
}

TEST(DelayConfig, TheFirstDelayLiesBetweenTheBounds) {
  DelayConfig config;
  config.minimum = 0.2;
  config.maximum = 0.3;
  config.initial = 0.16;
  EXPECT_EQ(validate(config), std::vector<std::string>{"initial = 0.16, expected a number in [0.2, 0.3] s"});
  config.initial = 0.25;
  EXPECT_TRUE(validate(config).empty());
  config.maximum = 0.1;
  EXPECT_TRUE(test_support::names(validate(config), "maximum")) << "below the minimum";
}

}  // namespace
}  // namespace laparoscope_servo::servo
