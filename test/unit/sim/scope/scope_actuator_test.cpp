#include "laparoscope_servo/sim/scope_actuator.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::sim {
namespace {

const Eigen::Vector4d kFast(0.02, -0.02, 0.02, 0.002);

TEST(ScopeActuator, ExecutesAfterTheDelay) {
  ScopeActuatorConfig config;
  config.delay = 0.1;
  config.dead_zone = {0.0, 0.0, 0.0, 0.0};
  ScopeActuator actuator(config);
  actuator.command(1.0, kFast);
  actuator.command(1.05, 2.0 * kFast);
  EXPECT_EQ(actuator.velocity(1.099), Eigen::Vector4d::Zero());
  EXPECT_EQ(actuator.velocity(1.1), kFast);
  EXPECT_EQ(actuator.velocity(1.149), kFast);
  EXPECT_EQ(actuator.velocity(1.15), 2.0 * kFast);
  EXPECT_EQ(actuator.velocity(9.0), 2.0 * kFast);
}

TEST(ScopeActuator, DeadZoneSubtractsItsWidth) {
  ScopeActuatorConfig config;
  config.delay = 0.0;
  ScopeActuator actuator(config);
  actuator.command(0.0, kFast);
  EXPECT_TRUE(actuator.velocity(0.0).isApprox(Eigen::Vector4d(0.016, -0.016, 0.016, 0.0016), 1e-12));
  actuator.command(1.0, Eigen::Vector4d(0.004, -0.004, 0.003, -0.0004));
  EXPECT_EQ(actuator.velocity(1.0), Eigen::Vector4d::Zero());
}

TEST(ScopeActuator, DeadZoneAsThreshold) {
  ScopeActuatorConfig config;
  config.delay = 0.0;
  config.dead_zone_kind = "threshold";
  ScopeActuator actuator(config);
  actuator.command(0.0, Eigen::Vector4d(0.0041, -0.0039, 0.004, -0.0005));
  EXPECT_EQ(actuator.velocity(0.0), Eigen::Vector4d(0.0041, 0.0, 0.0, -0.0005));
}

TEST(ScopeActuator, ValidationNamesWhatIsWrong) {
  EXPECT_TRUE(validate(ScopeActuatorConfig()).empty());
  ScopeActuatorConfig config;
  config.delay = std::numeric_limits<double>::quiet_NaN();
  config.dead_zone = {0.1, -0.1, std::numeric_limits<double>::infinity()};
  config.dead_zone_kind = "soft";
  const std::vector<std::string> errors = validate(config);
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_EQ(errors[0], "delay = nan, expected a number in [0, 2] s");
  EXPECT_EQ(errors[1].rfind("dead_zone has 3 elements, expected a list of 4 numbers", 0), 0u) << errors[1];
  EXPECT_EQ(errors[2], "dead_zone_kind = 'soft', expected one of: subtract, threshold");
  config.dead_zone = {0.1, 0.1, std::numeric_limits<double>::infinity(), 0.0};
  EXPECT_EQ(validate(config)[1].rfind("dead_zone[2] = inf", 0), 0u) << validate(config)[1];
}

}  // namespace
}  // namespace laparoscope_servo::sim
