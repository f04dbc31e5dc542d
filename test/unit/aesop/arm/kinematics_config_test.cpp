#include "laparoscope_servo/aesop/kinematics_config.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::aesop {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(KinematicsConfig, defaultsAreValid) {
  EXPECT_TRUE(validate(KinematicsConfig()).empty());
  EXPECT_TRUE(validate(MotionConfig()).empty());
}

TEST(KinematicsConfig, everyErrorIsNamed) {
  KinematicsConfig config;
  config.joints[1].a = kNan;
  config.joints[2].maximum = config.joints[2].minimum;
  config.joints[6].max_speed = 0.0;
  config.scope_length = -0.3;
  const std::vector<std::string> errors = validate(config);
  ASSERT_EQ(errors.size(), 4u);
  EXPECT_EQ(errors[0], "a[1] = nan, expected a list of 7 numbers in [-100, 100] m");
  EXPECT_EQ(errors[1], "max_speed[6] = 0, expected a list of 7 numbers in (0, 100] m/s or rad/s");
  EXPECT_EQ(errors[2], "scope_length = -0.3, expected a number in (0, 1) m");
  EXPECT_EQ(errors[3].rfind("maximum[2] = ", 0), 0u) << errors[3];
}

TEST(KinematicsConfig, fourDrivenAndTwoPassiveJoints) {
  KinematicsConfig config;
  config.joints[3].role = JointRole::kDriven;
  EXPECT_EQ(validate(config).size(), 1u);
  config = KinematicsConfig();
  config.joints[4].role = JointRole::kHand;
  EXPECT_EQ(validate(config).size(), 1u);
}

TEST(KinematicsConfig, passiveJointsTurn) {
  KinematicsConfig config;
  config.joints[4].prismatic = true;
  EXPECT_EQ(validate(config).size(), 1u);
}

TEST(MotionConfig, notANumberIsRefusedEverywhere) {
  MotionConfig config;
  config.limit_margin_angle = config.limit_margin_distance = config.singular_slow = config.singular_stop = kNan;
  config.lever_slow = config.lever_stop = config.stopping_time = kNan;
  EXPECT_EQ(validate(config).size(), 7u);
}

}  // namespace
}  // namespace laparoscope_servo::aesop
