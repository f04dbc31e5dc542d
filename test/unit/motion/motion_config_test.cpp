#include "laparoscope_servo/motion/motion_config.h"

#include <gtest/gtest.h>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::motion {
namespace {

TEST(MotionConfig, defaultsCanBeUsed) {
  EXPECT_TRUE(validate(MotionConfig()).empty());
}

TEST(MotionConfig, namesEveryError) {
  MotionConfig config;
  config.max_pixels = 1;
  config.saturation = 0;
  config.darkness = 256;
  config.min_usable = 0.0;
  config.min_share = 1.5;
  config.max_error = 0.0;
  config.velocity_damping = 1.1;
  config.state.confirmations = 0;
  EXPECT_EQ(validate(config).size(), 8u);
}

TEST(MotionConfig, modelsHaveTheirNames) {
  MotionConfig config;
  parameters::Table table;
  describe(table, config);
  table.find("model")->set(std::string("affine"));
  EXPECT_EQ(config.model, Model::kAffine);
}

}  // namespace
}  // namespace laparoscope_servo::motion
