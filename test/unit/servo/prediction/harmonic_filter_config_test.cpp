#include "laparoscope_servo/servo/harmonic_filter_config.h"

#include <gtest/gtest.h>

#include "support/config_check.h"

namespace laparoscope_servo::servo {
namespace {

using Config = HarmonicFilterConfig;
using Field = test_support::NumberField<Config>;

std::vector<std::string> errorsOf(const Config& config) {
  return validate(config);
}

TEST(HarmonicFilterConfig, TheDefaultsAreValid) {
  EXPECT_TRUE(validate(Config()).empty());
}

TEST(HarmonicFilterConfig, EachNumberHasItsRange) {
  using test_support::expectRange;
  const Config usual;
  expectRange(Field("min_frequency", &Config::min_frequency), 0.05, 2.0, errorsOf);
  expectRange(Field("max_frequency", &Config::max_frequency), usual.min_frequency, 2.0, errorsOf);
  expectRange(Field("horizon", &Config::horizon), 0.04, 0.5, errorsOf);
  expectRange(Field("window", &Config::window), 5.0, 60.0, errorsOf);
  expectRange(Field("max_gap", &Config::max_gap), 0.1, 5.0, errorsOf);
  expectRange(Field("variation", &Config::variation), 0.0, 1.0, errorsOf);
  expectRange(Field("offset_walk", &Config::offset_walk), 0.0, 100.0, errorsOf);
  expectRange(Field("frequency_walk", &Config::frequency_walk), 0.0, 0.1, errorsOf);
  expectRange(Field("lock_ratio", &Config::lock_ratio), 0.01, 0.9, errorsOf);
  expectRange(Field("unlock_ratio", &Config::unlock_ratio), usual.lock_ratio, 1.0, errorsOf);
  expectRange(Field("jump", &Config::jump), 3.0, 1000.0, errorsOf);
}

// The filter has room for six: kMaxHarmonics of harmonic_kalman.h.
TEST(HarmonicFilterConfig, ThereIsRoomForSixHarmonics) {
  test_support::expectRange(Field("harmonics", &Config::harmonics), 1, 6, errorsOf);
}

// A filter that unlocks below where it locks would change with each image.
TEST(HarmonicFilterConfig, UnlocksNoEarlierThanItLocks) {
  Config config;
  config.lock_ratio = 0.5;
  config.unlock_ratio = 0.4;
  EXPECT_EQ(validate(config), std::vector<std::string>{"unlock_ratio = 0.4, expected a number in [0.5, 1]"});
}

}  // namespace
}  // namespace laparoscope_servo::servo
