#include "laparoscope_servo/model/model_config.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::model {
namespace {

TEST(ModelConfig, theDefaultsAreValid) {
  EXPECT_TRUE(validate(ModelConfig()).empty());
}

TEST(ModelConfig, eachErrorNamesItsField) {
  ModelConfig config;
  config.start_rotation = std::nan("");
  config.start_share = 0.0;
  config.edges.min_contrast = -1.0;
  const std::vector<std::string> errors = validate(config);
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_NE(errors[0].find("edges/min_contrast"), std::string::npos) << errors[0];
  EXPECT_NE(errors[1].find("start_rotation"), std::string::npos) << errors[1];
  EXPECT_NE(errors[2].find("start_share"), std::string::npos) << errors[2];
}

}  // namespace
}  // namespace laparoscope_servo::model
