// What ends the pattern of a calibration: the arm stands within delay, time to live and braking, and the insertion
// point stays what it was.
#include <gtest/gtest.h>

#include <filesystem>

#include "system/aesop/calibration_bench.h"

namespace laparoscope_servo::test {
namespace {

constexpr double kLongestStop = 0.2 + 0.025 + 0.16 + 0.15 + 0.1;  // s; the last is for this machine's scheduling

class CalibrationStop : public ::testing::Test {
 protected:
  // Ends the pattern by `cause`.
  void expectStanding(const std::function<void()>& cause, const std::string& reason) {
    ASSERT_TRUE(cart_.startPattern()) << cart_.state->message;
    cause();
    EXPECT_LT(cart_.bench.timeToStandStill(), kLongestStop);
    EXPECT_EQ(cart_.bench.motionWithin(0.5), 0.0);
    EXPECT_FALSE(std::filesystem::exists(cart_.file()));
    if (reason.empty()) return;
    ASSERT_TRUE(cart_.waitForState(CalibrationState::FAILED)) << cart_.state->message;
    EXPECT_NE(cart_.state->message.find(reason), std::string::npos) << cart_.state->message;
    EXPECT_FALSE(cart_.bench.stateIs("ENABLED"));
  }

  CalibrationBench cart_;
};

TEST_F(CalibrationStop, Cancel) {
  expectStanding([&] { EXPECT_TRUE(cart_.cancel().success); }, "cancelled");
  EXPECT_TRUE(cart_.bench.waitFor([&] { return cart_.bench.stateIs("DISABLED"); }));
  EXPECT_TRUE(cart_.bench.startMoving()) << "it may be enabled again";
}

TEST_F(CalibrationStop, Disable) {
  expectStanding([&] { EXPECT_TRUE(cart_.bench.call("disable").success); }, "disabled on request");
}

TEST_F(CalibrationStop, AFault) {
  expectStanding([&] { cart_.bench.truth().fault("bits", aesop::kFaultMotor); }, "motor");
  EXPECT_TRUE(cart_.bench.stateIs("FAULT"));
}

TEST_F(CalibrationStop, ACommandOfSomebodyElse) {
  expectStanding(
      [&] {
        cart_.bench.send(0.0, 0.0, ros::Time::now());
        EXPECT_FALSE(cart_.bench.waitFor([&] { return cart_.state->state == CalibrationState::FAILED; }, 0.2));
        cart_.bench.send(0.02, 0.0, ros::Time::now());
        EXPECT_TRUE(cart_.waitForState(CalibrationState::FAILED));
      },
      "somebody else");
}

TEST_F(CalibrationStop, ALostLine) {
  expectStanding([&] { cart_.bench.truth().fault("hangup"); }, "");
  EXPECT_TRUE(cart_.waitForState(CalibrationState::FAILED)) << cart_.state->message;
}

TEST_F(CalibrationStop, TheNodeIsTerminated) {
  expectStanding([&] { cart_.bench.node().kill(SIGTERM); }, "");
  EXPECT_EQ(cart_.bench.node().exitStatus(5.0), 0);
  EXPECT_EQ(cart_.bench.truth().motion().state, "DISABLED");
}

TEST_F(CalibrationStop, TheNodeIsKilled) {
  expectStanding([&] { cart_.bench.node().kill(SIGKILL); }, "");
}

TEST_F(CalibrationStop, TheNodeIsStopped) {
  expectStanding([&] { cart_.bench.node().kill(SIGSTOP); }, "");
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "aesop_calibration_stop_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
