// What ends the pattern of a calibration: the arm stands, and the insertion point stays what it was.
#include <cmath>

#include "unit/ros/calibration_loop.h"

namespace laparoscope_servo {
namespace {

TEST_F(CalibrationTest, CancelStopsThePattern) {
  startPattern();
  EXPECT_NE(calibration_.finish(now_).find("ends by itself"), std::string::npos);
  ASSERT_EQ(calibration_.cancel(now_), "");
  expectStandingAndUnchanged("cancelled");
}

TEST_F(CalibrationTest, DisableStopsThePattern) {
  startPattern();
  ASSERT_EQ(driver_.disable(now_), "");
  expectStandingAndUnchanged("disabled on request");
}

TEST_F(CalibrationTest, PauseStopsThePattern) {
  startPattern();
  ASSERT_EQ(driver_.pause(), "");
  expectStandingAndUnchanged("the arm is PAUSED");
}

TEST_F(CalibrationTest, AFaultStopsThePattern) {
  startPattern();
  emulator_.setFaultCause(aesop::kFaultMotor, now_);
  expectStandingAndUnchanged("motor", OperatingMode::kFault);
  EXPECT_NE(driver_.state(now_).reason.find("motor"), std::string::npos) << driver_.state(now_).reason;
}

TEST_F(CalibrationTest, ACutLineStopsThePattern) {
  startPattern();
  cut_ = true;
  expectStandingAndUnchanged("not connected");
}

TEST_F(CalibrationTest, ARestartOfTheControllerStopsThePattern) {
  startPattern();
  emulator_.reboot(now_);
  expectStandingAndUnchanged("");
}

TEST_F(CalibrationTest, ACommandOfSomebodyElseStopsThePattern) {
  startPattern();
  calibration_.otherCommand({}, now_);
  EXPECT_TRUE(calibration_.drives()) << "the zeros of a controller that is not engaged mean nothing";
  calibration_.otherCommand({0.0, 0.0, 0.0, 1e-4}, now_);
  expectStandingAndUnchanged("somebody else");
}

TEST_F(CalibrationTest, ACommandOfSomebodyElseThatIsNotFiniteStopsThePattern) {
  startPattern();
  calibration_.otherCommand({std::nan(""), 0.0, 0.0, 0.0}, now_);
  expectStandingAndUnchanged("somebody else");
}

TEST_F(CalibrationTest, AStandingClockStopsThePattern) {
  startPattern();
  const double frozen = stamp();
  for (int k = 0; k < 40 && calibration_.drives(); ++k) {
    now_ += kTick;
    calibration_.step(frozen - 1.0, now_);
    const aesop::Bytes requests = driver_.transmit(now_);
    const aesop::Bytes replies = emulator_.receive(requests.data(), requests.size(), now_);
    driver_.receive(replies.data(), replies.size(), now_);
  }
  expectStandingAndUnchanged("command was refused");
}

TEST_F(CalibrationTest, AShaftThatIsFarFromThePointIsNotDriven) {
  aesop::DriverConfig config;
  config.insertion_point += Vector3d(0.03, 0.0, 0.0);
  driver_ = aesop::Driver(config);
  driver_.opened(now_);
  enable();
  ASSERT_EQ(calibration_.start(Method::kPattern, now_), "");
  const aesop::JointVector before = emulator_.arm().position();
  run(1.0);
  EXPECT_EQ(calibration_.stage(), Stage::kFailed);
  EXPECT_NE(calibration_.message().find("the shaft passes the insertion point at"), std::string::npos);
  EXPECT_EQ(emulator_.arm().position(), before);
}

}  // namespace
}  // namespace laparoscope_servo
