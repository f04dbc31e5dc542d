// Calibrations of the driver in a closed loop with the emulated controller, in simulated time.
#include "laparoscope_servo/ros/insertion_point_calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "laparoscope_servo/ros/insertion_point_file.h"
#include "laparoscope_servo/sim/emulator.h"
#include "laparoscope_servo/sim/wire.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo::skin {
namespace {

using aesop::OperatingMode;
using Eigen::Vector3d;
using Method = CalibrationMethod;
using Stage = CalibrationStage;

constexpr double kTick = 0.005;          // s
constexpr double kStampOffset = 1000.0;  // s, of the stamping clock ahead of the steady one
const Vector3d kBelieved = aesop::DriverConfig().insertion_point;
const Vector3d kWrong{0.006, -0.006, 0.0055};  // m, 10 mm: where the trocar really is, from there

class CalibrationTest : public ::testing::Test {
 protected:
  explicit CalibrationTest(double pattern_angle = 0.12) : pattern_angle_(pattern_angle) { driver_.opened(0.0); }

  static sim::EmulatorConfig displaced() {
    sim::EmulatorConfig config;
    config.arm.insertion_point += kWrong;
    return config;
  }
  CalibrationParameters parameters() const {
    CalibrationParameters parameters;
    parameters.file = folder_.file("point.yaml");
    parameters.pattern.speed = 0.1;
    parameters.pattern.angle = pattern_angle_;
    return parameters;
  }

  void run(double seconds) {
    const double end = now_ + seconds;
    while (now_ < end - 1e-9) {
      now_ += kTick;
      moved_ += calibration_.step(stamp(), now_) ? 1 : 0;
      const aesop::Bytes to_host = wire_.to_host.pop(now_);
      if (!cut_) driver_.receive(to_host.data(), to_host.size(), now_);
      const aesop::Bytes requests = driver_.transmit(now_);
      if (!cut_) wire_.to_controller.push(requests, wire_.faults, now_);
      const aesop::Bytes arrived = wire_.to_controller.pop(now_);
      wire_.to_host.push(emulator_.receive(arrived.data(), arrived.size(), now_), wire_.faults, now_);
      if (calibration_.stage() == Stage::kFailed && failed_at_ < 0.0) failed_at_ = now_;
    }
  }
  double stamp() const { return kStampOffset + now_; }
  void hand(double pan, double tilt, double insertion = 0.0, double seconds = 1.0) {
    ASSERT_EQ(emulator_.hand({pan, tilt, 0.0, insertion}, seconds, now_), "");
    run(seconds + 0.2);
  }
  void swing(double size) {
    hand(size, 0.0);
    hand(-2.0 * size, 0.0, 0.005);
    hand(size, size);
    hand(0.0, -2.0 * size, -0.005);
    hand(0.0, size);
  }
  void connect() { run(0.5); }
  void enable() {
    connect();
    ASSERT_EQ(driver_.enable(stamp(), now_), "");
    run(0.3);
    ASSERT_TRUE(driver_.session().isEnabled());
  }
  void startPattern() {
    enable();
    ASSERT_EQ(calibration_.start(Method::kPattern, now_), "");
    run(2.0);
    ASSERT_EQ(calibration_.stage(), Stage::kCollecting) << calibration_.message();
    ASSERT_FALSE(emulator_.arm().velocity().isZero(0.0));
  }
  // After what ended the pattern: the arm stands within what delay, time to live and braking take, DISABLED or in
  // FAULT.
  void expectStandingAndUnchanged(const std::string& reason, OperatingMode mode = OperatingMode::kDisabled) {
    run(0.2 + 0.03 + 0.16 + 0.15);
    EXPECT_TRUE(emulator_.arm().velocity().isZero(0.0));
    run(1.0);
    EXPECT_TRUE(emulator_.arm().velocity().isZero(0.0));
    EXPECT_EQ(calibration_.stage(), Stage::kFailed);
    EXPECT_NE(calibration_.message().find(reason), std::string::npos) << calibration_.message();
    EXPECT_FALSE(calibration_.drives());
    EXPECT_EQ(driver_.state(now_).mode, mode) << driver_.state(now_).reason;
    EXPECT_EQ(driver_.insertionPoint(), kBelieved);
    EXPECT_EQ(moved_, 0);
    EXPECT_FALSE(std::filesystem::exists(parameters().file));
  }
  void expectCalibrated() {
    const servo::InsertionPointFit& fit = calibration_.fit();
    const Vector3d error = fit.point - (kBelieved + kWrong);
    EXPECT_LT(error.norm(), 1e-3);
    EXPECT_LT(error.dot(fit.covariance.inverse() * error), 9.0) << "3 standard deviations";
    EXPECT_EQ(driver_.insertionPoint(), fit.point);
    EXPECT_EQ(moved_, 1);
    const CalibratedInsertionPoint saved = loadInsertionPoint(parameters().file, driver_.kinematics());
    EXPECT_LT((saved.point - fit.point).norm(), 1e-8);
    EXPECT_EQ(saved.poses.size(), static_cast<std::size_t>(fit.poses));
    EXPECT_NE(calibration_.message().find(parameters().file), std::string::npos) << calibration_.message();
  }

  const double pattern_angle_;
  const test_support::TemporaryFolder folder_;
  double now_ = 0.0;
  double failed_at_ = -1.0;
  bool cut_ = false;
  int moved_ = 0;
  aesop::Driver driver_{aesop::DriverConfig()};
  sim::Emulator emulator_{displaced(), 0.0};
  sim::Wire wire_{1};
  InsertionPointCalibration calibration_{parameters(), driver_};
};

TEST_F(CalibrationTest, ByHand) {
  connect();
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  swing(0.13);
  EXPECT_EQ(calibration_.message(), "enough; finish, or go on");
  ASSERT_EQ(calibration_.finish(now_), "");
  EXPECT_EQ(calibration_.stage(), Stage::kDone);
  run(0.1);
  expectCalibrated();
  EXPECT_EQ(loadInsertionPoint(parameters().file, driver_.kinematics()).method, "HAND");
  EXPECT_EQ(driver_.state(now_).mode, OperatingMode::kDisabled);
}

TEST_F(CalibrationTest, ByPattern) {
  startPattern();
  run(15.0);
  EXPECT_EQ(calibration_.stage(), Stage::kDone) << calibration_.message();
  expectCalibrated();
  EXPECT_EQ(loadInsertionPoint(parameters().file, driver_.kinematics()).method, "PATTERN");
  EXPECT_EQ(driver_.state(now_).mode, OperatingMode::kDisabled);
  // About the new point, the arm drives as ever.
  enable();
  EXPECT_EQ(driver_.command({0.05, 0.0, 0.0, 0.0}, stamp(), stamp(), now_), "");
  run(0.3);
  EXPECT_FALSE(emulator_.arm().velocity().isZero(0.0));
}

TEST_F(CalibrationTest, AnotherOneStartsAfresh) {
  connect();
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  EXPECT_NE(calibration_.start(Method::kHand, now_).find("under way"), std::string::npos);
  swing(0.13);
  ASSERT_EQ(calibration_.finish(now_), "");
  EXPECT_EQ(calibration_.finish(now_), "no calibration is under way");
  EXPECT_EQ(calibration_.cancel(now_), "no calibration is under way");
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  EXPECT_EQ(calibration_.fit().poses, 0);
  EXPECT_NE(calibration_.finish(now_), "");
}

TEST_F(CalibrationTest, TooLittleMotionIsRefusedAndMayGoOn) {
  connect();
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  run(2.0);
  EXPECT_NE(calibration_.finish(now_).find("poses of different directions: 1, expected at least 30"), std::string::npos)
      << calibration_.finish(now_);
  swing(0.04);
  const std::string small = calibration_.finish(now_);
  EXPECT_NE(small.find("the shaft has turned by 0.02"), std::string::npos) << small;
  EXPECT_NE(small.find("expected at least 0.07 rad"), std::string::npos) << small;
  EXPECT_EQ(calibration_.stage(), Stage::kCollecting);
  EXPECT_EQ(driver_.insertionPoint(), kBelieved);
  swing(0.15);
  EXPECT_EQ(calibration_.finish(now_), "");
}

TEST_F(CalibrationTest, ACancelledOneLeavesThePointAsItWas) {
  connect();
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  swing(0.13);
  ASSERT_EQ(calibration_.cancel(now_), "");
  expectStandingAndUnchanged("cancelled");
}

TEST_F(CalibrationTest, AnEnableEndsOneByHand) {
  connect();
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  swing(0.13);
  ASSERT_EQ(driver_.enable(stamp(), now_), "");
  run(0.3);
  EXPECT_EQ(calibration_.stage(), Stage::kFailed);
  EXPECT_NE(calibration_.message().find("the arm is ENABLED"), std::string::npos) << calibration_.message();
  EXPECT_EQ(driver_.insertionPoint(), kBelieved);
}

TEST_F(CalibrationTest, AFileThatCannotBeWrittenKeepsTheOldPointAndThePoses) {
  connect();
  std::filesystem::create_directory(parameters().file);
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  swing(0.13);
  EXPECT_NE(calibration_.finish(now_).find("cannot write '" + parameters().file), std::string::npos);
  run(0.1);
  EXPECT_EQ(driver_.insertionPoint(), kBelieved);
  std::filesystem::remove(parameters().file);
  EXPECT_EQ(calibration_.finish(now_), "");
  run(0.1);
  EXPECT_EQ(driver_.insertionPoint(), calibration_.fit().point);
}

TEST_F(CalibrationTest, TheNewPointWaitsForAnArmThatIsDisabledAndAtRest) {
  connect();
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  swing(0.13);
  ASSERT_EQ(emulator_.hand({0.05, 0.0, 0.0, 0.0}, 1.0, now_), "");
  run(0.3);
  ASSERT_EQ(calibration_.finish(now_), "");
  run(0.3);
  EXPECT_EQ(driver_.insertionPoint(), kBelieved) << "the scope is in motion";
  run(1.0);
  EXPECT_EQ(driver_.insertionPoint(), calibration_.fit().point);
  enable();
  EXPECT_NE(driver_.setInsertionPoint(kBelieved).find("the arm is ENABLED"), std::string::npos);
  EXPECT_EQ(driver_.insertionPoint(), calibration_.fit().point);
}

TEST_F(CalibrationTest, StartIsRefusedInTheWrongState) {
  EXPECT_NE(calibration_.start(Method::kHand, now_).find("not connected"), std::string::npos);
  connect();
  EXPECT_NE(calibration_.start(Method::kPattern, now_).find("has to be ENABLED"), std::string::npos);
  enable();
  EXPECT_NE(calibration_.start(Method::kHand, now_).find("has to be DISABLED"), std::string::npos);
  ASSERT_EQ(driver_.command({0.05, 0.0, 0.0, 0.0}, stamp(), stamp(), now_), "");
  EXPECT_NE(calibration_.start(Method::kPattern, now_).find("at rest"), std::string::npos);
  EXPECT_EQ(calibration_.stage(), Stage::kIdle);
}

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

class NarrowPatternTest : public CalibrationTest {
 protected:
  NarrowPatternTest() : CalibrationTest(0.04) {}
};

TEST_F(NarrowPatternTest, APatternThatShowsTooLittleIsRefused) {
  startPattern();
  run(12.0);
  expectStandingAndUnchanged("the shaft has turned by 0.0");
}

}  // namespace
}  // namespace laparoscope_servo::skin
