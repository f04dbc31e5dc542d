// The driver in a closed loop with the emulated controller, in simulated time, and a calibration of its insertion
// point, from which the trocar is 10 mm away.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "laparoscope_servo/sim/emulator.h"
#include "laparoscope_servo/sim/wire.h"
#include "ros/aesop/insertion_point_calibration.h"
#include "ros/aesop/insertion_point_file.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {

using aesop::OperatingMode;
using Eigen::Vector3d;
using Method = CalibrationMethod;
using Stage = CalibrationStage;

inline constexpr double kTick = 0.005;          // s
inline constexpr double kStampOffset = 1000.0;  // s, of the stamping clock ahead of the steady one
inline const Vector3d kBelieved = aesop::DriverConfig().insertion_point;
inline const Vector3d kWrong{0.006, -0.006, 0.0055};  // m, 10 mm: where the trocar really is, from there

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
    parameters.pattern_allowed = true;
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
      if (!cut_) wire_.to_controller.push(requests, now_);
      const aesop::Bytes arrived = wire_.to_controller.pop(now_);
      wire_.to_host.push(emulator_.receive(arrived.data(), arrived.size(), now_), now_);
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

}  // namespace laparoscope_servo
