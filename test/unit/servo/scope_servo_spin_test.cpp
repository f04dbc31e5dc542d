// What ScopeServo does about the orientation.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "scope_loop.h"

namespace laparoscope_servo::servo {
namespace {

using test::kPeriod;
using test::straight;
using test::withoutDeadZone;

// The image turns, the tissue goes along: a released scope does not spin, with any optics.
TEST(ScopeServo, ReleasedItNeverSpins) {
  ControllerConfig config;
  config.spin = SpinMode::kReleased;
  ScopeServo servo(config);
  bool moved_at_all = false;
  for (int k = 0; k < 300; ++k) {
    ServoInput input;
    input.time = input.image_time = 0.04 * k;
    input.period = 0.04;
    input.scope = {scope::obliqueOptics(0.5236), 0.1};
    input.error.x = 0.002 * k;
    input.error.alpha = 0.004 * k;
    const scope::Velocity command = servo.command(input, ServoLimits());
    ASSERT_EQ(command.spin, 0.0) << k;
    moved_at_all |= command.pan != 0.0;
  }
  EXPECT_TRUE(moved_at_all);
}

// The picture hangs upside down: noise does not decide in each image which way round it is turned.
TEST(ScopeServo, HalfATurnIsGoneInOneDirection) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.05);
  for (int start = 0; start < 10; ++start) {
    ScopeServo servo{ControllerConfig()};
    double alpha = M_PI, last = 0.0;
    int reversals = 0;
    for (int k = 0; k < 800; ++k) {
      ServoInput input;
      input.time = input.image_time = 0.04 * k;
      input.period = 0.04;
      input.scope = straight();
      input.error.alpha = std::remainder(alpha + noise(random), 2.0 * M_PI);
      const double spin = servo.command(input, ServoLimits()).spin;
      const bool far = std::abs(std::remainder(alpha, 2.0 * M_PI)) > 0.3;
      if (far && spin * last < 0.0) ++reversals;
      if (spin != 0.0) last = spin;
      alpha -= 0.04 * spin;
    }
    EXPECT_EQ(reversals, 0) << start;
    EXPECT_LT(std::abs(std::remainder(alpha, 2.0 * M_PI)), 0.1);
  }
}

// The angle of a scope that is kept upright, in each step; its images are `lag` [s] older than its poses.
std::vector<double> keptUpright(double lag) {
  ControllerConfig config = withoutDeadZone();
  config.spin = SpinMode::kUpright;
  config.predictor.delay = 0.0;
  config.predictor.measure_delay = false;
  config.rest.enabled = false;
  config.horizon.up = {0.0, -1.0, 0.0};
  ScopeServo servo(config);
  std::vector<double> angles{0.5};
  for (int k = 0; k < 400; ++k) {
    ServoInput input;
    input.time = input.pose_time = kPeriod * k;
    input.image_time = std::max(0.0, input.time - lag);
    input.period = kPeriod;
    input.scope = straight();
    Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
    tip.linear() = geometry::so3Exp({0.0, 0.0, angles.back()});
    input.insertion_point_T_tip = tip;
    angles.push_back(angles.back() + kPeriod * servo.command(input, ServoLimits()).spin);
  }
  return angles;
}

// What the scope has turned since the image was taken is not counted twice, by its pose and by what it was told.
TEST(ScopeServo, TheHorizonIsThatOfTheImage) {
  const std::vector<double> at_once = keptUpright(0.0), late = keptUpright(0.2);
  EXPECT_LT(std::abs(at_once.back()), 1e-3);
  for (std::size_t k = 0; k < late.size(); ++k) EXPECT_NEAR(late[k], at_once[k], 2e-3) << k;
}

}  // namespace
}  // namespace laparoscope_servo::servo
