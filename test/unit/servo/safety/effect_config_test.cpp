#include "laparoscope_servo/servo/effect_config.h"

#include <gtest/gtest.h>

#include "support/config_check.h"

namespace laparoscope_servo::servo {
namespace {

using Config = EffectConfig;

TEST(EffectConfig, TheDefaultsAreValid) {
  EXPECT_TRUE(parameters::errorsOf(Config()).empty());
}

TEST(EffectConfig, ParametersAreTheFieldsOfTheirNames) {
  test_support::expectRowsAreFields<Config>({{"tissue_centre", &Config::tissue_centre},
                                             {"tissue_depth", &Config::tissue_depth},
                                             {"tissue_orientation", &Config::tissue_orientation},
                                             {"tissue_time", &Config::tissue_time},
                                             {"unrest_time", &Config::unrest_time},
                                             {"memory", &Config::memory},
                                             {"doubt", &Config::doubt},
                                             {"release", &Config::release},
                                             {"certain", &Config::certain},
                                             {"standing_time", &Config::standing_time},
                                             {"unconfirmed_turn", &Config::unconfirmed_turn},
                                             {"unconfirmed_insertion", &Config::unconfirmed_insertion}});
}

// If the tissue could not move by itself, every breath would count as a fault; if the scope might not move before its
// effect is seen, it could never show one.
TEST(EffectConfig, NothingThatEvidenceIsDividedByIsZero) {
  Config config;
  config.tissue_centre = config.tissue_depth = config.tissue_orientation = config.tissue_time = config.memory = 0.0;
  config.unconfirmed_turn = config.unconfirmed_insertion = 0.0;
  const std::vector<std::string> errors = parameters::errorsOf(config);
  EXPECT_EQ(errors.size(), 7u);
  for (const char* const name : {"tissue_centre", "tissue_depth", "tissue_orientation", "tissue_time", "memory",
                                 "unconfirmed_turn", "unconfirmed_insertion"})
    EXPECT_TRUE(test_support::names(errors, name)) << name;
}

// release <= doubt <= certain.
TEST(EffectConfig, ThresholdsOfTheEvidenceAreInOrder) {
  Config config;
  config.release = config.doubt = config.certain = 6.0;
  EXPECT_TRUE(parameters::errorsOf(config).empty());
  config.release = 6.1;
  EXPECT_EQ(parameters::errorsOf(config), std::vector<std::string>{"doubt = 6, expected at least release = 6.1"});
  config.release = 3.0;
  config.certain = 5.9;
  EXPECT_EQ(parameters::errorsOf(config), std::vector<std::string>{"certain = 5.9, expected at least doubt = 6"});
}

}  // namespace
}  // namespace laparoscope_servo::servo
