#include "laparoscope_servo/aesop/motion_monitor.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::aesop {
namespace {

using Speed = std::array<double, kDrivenJoints>;

class MotionMonitorTest : public ::testing::Test {
 protected:
  // Statuses at 40 Hz of an arm that does `real` while `speed` is commanded; the reason, or an empty string when
  // nothing is found within `seconds`.
  std::string run(const Speed& speed, const Speed& real, double seconds) {
    for (const double end = now_ + seconds; now_ < end;) {
      now_ += kPeriod;
      status_.time += kPeriod;
      for (std::size_t k = 0; k < kDrivenJoints; ++k) {
        const int joint = kinematics_.driven()[k];
        status_.position[joint] += kPeriod * real[k];
        status_.velocity[joint] = real[k];
      }
      const std::string reason = monitor_.take(status_, speed, now_);
      if (!reason.empty()) return reason;
    }
    return "";
  }
  static bool mentions(const std::string& text, const std::string& what) {
    return text.find(what) != std::string::npos;
  }

  static constexpr double kPeriod = 0.025;
  double now_ = 100.0;
  Status status_;
  Kinematics kinematics_{KinematicsConfig()};
  MotionMonitor monitor_{MonitorConfig(), kinematics_};
};

TEST_F(MotionMonitorTest, anArmThatObeysLateIsFine) {
  const Speed speed{0.005, -0.05, 0.1, 0.3};
  EXPECT_EQ(run({}, {}, 3.0), "");
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(run(speed, {}, 0.2), "");
    EXPECT_EQ(run(speed, speed, 3.0), "");
    EXPECT_EQ(run({}, speed, 0.2), "");
    EXPECT_EQ(run({}, {}, 0.5 * k), "");
  }
}

TEST_F(MotionMonitorTest, aJointThatStandsIsNamed) {
  const Speed speed{0.005, -0.02, 0.0, 0.0};
  EXPECT_EQ(run(speed, speed, 2.0), "");
  const double begin = now_;
  const std::string reason = run(speed, {0.005, 0.0, 0.0, 0.0}, 3.0);
  EXPECT_TRUE(mentions(reason, "joint 2") && mentions(reason, "does not follow")) << reason;
  EXPECT_LT(now_ - begin, 1.1);
}

TEST_F(MotionMonitorTest, oneThatGoesTheOtherWayDoesNotFollow) {
  EXPECT_TRUE(mentions(run({0.0, 0.0, 0.02, 0.0}, {0.0, 0.0, -0.02, 0.0}, 3.0), "joint 3"));
}

TEST_F(MotionMonitorTest, frictionHoldsAgainstSlowOrChangingCommands) {
  EXPECT_EQ(run({0.0015, 0.008, -0.008, 0.004}, {}, 5.0), "");
  for (int k = 0; k < 20; ++k) EXPECT_EQ(run({0.0, k % 2 == 0 ? 0.02 : -0.02, 0.0, 0.0}, {}, 0.3), "");
}

TEST_F(MotionMonitorTest, motionNobodyHasCommanded) {
  EXPECT_EQ(run({}, {}, 0.5), "");
  const std::string reason = run({}, {0.0, 0.0, 0.0, -0.05}, 3.0);
  EXPECT_TRUE(mentions(reason, "joint 7") && mentions(reason, "nobody")) << reason;
  monitor_.reset();
  EXPECT_TRUE(mentions(run({0.01, 0.0, 0.0, 0.0}, {0.04, 0.0, 0.0, 0.0}, 3.0), "joint 1")) << "far too fast";
}

// Slower than what a window bears.
TEST_F(MotionMonitorTest, aJointThatCreepsIsNoticed) {
  const double begin = now_;
  const std::string reason = run({}, {0.0, 0.005, 0.0, 0.0}, 20.0);
  EXPECT_TRUE(mentions(reason, "joint 2") && mentions(reason, "crept")) << reason;
  EXPECT_LT(now_ - begin, 2.0 + 0.01 / 0.005 + 0.1);
}

TEST_F(MotionMonitorTest, restBeginsAnewWithEachCommand) {
  const Speed speed{0.0, 0.02, 0.0, 0.0};
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(run({}, {}, 3.0), "");
    EXPECT_EQ(run(speed, speed, 1.0), "");
    EXPECT_EQ(run({}, speed, 0.2), "");
  }
}

TEST_F(MotionMonitorTest, aJumpIsNoticedAtOnce) {
  EXPECT_EQ(run({}, {}, 0.1), "");
  status_.position[1] += 0.2;
  EXPECT_TRUE(mentions(run({}, {}, 0.01), "joint 2"));
}

TEST_F(MotionMonitorTest, positionsAndVelocitiesThatContradict) {
  const Speed speed{0.0, 0.0, 0.03, 0.0};
  EXPECT_EQ(run(speed, speed, 2.0), "");
  std::string reason;
  for (int k = 0; k < 100 && reason.empty(); ++k) {
    now_ += kPeriod;
    status_.time += kPeriod;
    status_.position[2] += kPeriod * speed[2];
    status_.velocity.setZero();
    reason = monitor_.take(status_, speed, now_);
  }
  EXPECT_TRUE(mentions(reason, "joint 3") && mentions(reason, "contradicts")) << reason;
}

TEST_F(MotionMonitorTest, numbersThatAreNoneAreNotTaken) {
  EXPECT_EQ(run({}, {}, 0.1), "");
  status_.position[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(run({}, {}, 0.01), "");
}

TEST_F(MotionMonitorTest, aResetForgets) {
  EXPECT_EQ(run({}, {}, 2.0), "");
  monitor_.reset();
  status_.position[1] += 0.2;  // a hand has moved it
  EXPECT_EQ(run({}, {}, 2.0), "");
}

TEST(MonitorConfig, errorsNameTheField) {
  EXPECT_TRUE(validate(MonitorConfig()).empty());
  MonitorConfig config;
  config.response_time = 0.0;
  config.tolerance_angle = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::string> errors = validate(config);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(errors[0].rfind("response_time = 0", 0), 0u);
  EXPECT_EQ(errors[1].rfind("tolerance_angle", 0), 0u);
}

}  // namespace
}  // namespace laparoscope_servo::aesop
