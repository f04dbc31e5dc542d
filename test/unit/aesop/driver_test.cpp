// The driver in a closed loop with the emulated controller, in simulated time, over lines good and bad, through each of
// two wire formats: nothing but the codec knows which.
#include "laparoscope_servo/aesop/driver.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "laparoscope_servo/sim/faults.h"
#include "line_codec.h"

namespace laparoscope_servo::aesop {
namespace {

constexpr double kTick = 0.005;
constexpr double kStampOffset = 1000.0;  // s, of the stamping clock ahead of the steady one

struct NamedFormat {
  const char* name;
  CodecFactory codec;
};

class DriverTest : public ::testing::TestWithParam<NamedFormat> {
 protected:
  explicit DriverTest() { driver_.opened(0.0); }

  static DriverConfig driverConfig() {
    DriverConfig config;
    config.session.codec = GetParam().codec;
    return config;
  }
  static sim::EmulatorConfig emulatorConfig() {
    sim::EmulatorConfig config;
    config.codec = GetParam().codec;
    return config;
  }

  // Lets `seconds` pass; commands at 25 Hz when `pan` is not zero.
  void run(double seconds, double pan = 0.0) {
    const double end = now_ + seconds;
    while (now_ < end - 1e-9) {
      now_ += kTick;
      if (pan != 0.0 && ++commands_ % 8 == 0) command({pan, 0.0, 0.0, 0.0});
      if (!host_alive_) {
        emulator_.step(now_);
        continue;
      }
      const Bytes to_host = wire_.to_host.pop(now_);
      if (!cut_) driver_.receive(to_host.data(), to_host.size(), now_);
      const Bytes requests = driver_.transmit(now_);
      if (!cut_) wire_.to_controller.push(requests, now_);
      const Bytes arrived = wire_.to_controller.pop(now_);
      wire_.to_host.push(emulator_.receive(arrived.data(), arrived.size(), now_), now_);
    }
  }
  std::string command(const scope::Velocity& velocity) {
    return driver_.command(velocity, kStampOffset + now_, kStampOffset + now_, now_);
  }
  void enable() {
    run(0.5);
    ASSERT_EQ(driver_.enable(kStampOffset + now_, now_), "");
    run(0.3);
    ASSERT_EQ(mode(), OperatingMode::kEnabled) << driver_.state(now_).reason;
  }
  void startMoving() {
    enable();
    run(1.0, 0.05);
    ASSERT_TRUE(emulator_.arm().isMoving());
  }
  // s until the joints stand, at most 5.
  double timeToStand(double pan = 0.0) {
    const double start = now_;
    while (!emulator_.arm().velocity().isZero(0.0) && now_ - start < 5.0) run(kTick, pan);
    return now_ - start;
  }
  std::string begin(const std::string& fault, const std::string& value = "") {
    sim::Fault one;
    one.name = fault;
    one.value = value;
    return faults_.begin(one, now_);
  }
  OperatingMode mode() const { return driver_.state(now_).mode; }

  // Age of a command at which it ends, its way, the controller's delay, the joints' braking.
  static constexpr double kLongestStop = 0.2 + 0.03 + 0.16 + 0.15;

  double now_ = 0.0;
  int commands_ = 0;
  bool host_alive_ = true;
  bool cut_ = false;
  Driver driver_{driverConfig()};
  sim::Emulator emulator_{emulatorConfig(), 0.0};
  sim::Wire wire_{1};
  sim::Faults faults_{emulator_, wire_};
};

TEST_P(DriverTest, theScopeTurnsAsCommanded) {
  const Kinematics kinematics{KinematicsConfig()};
  const Eigen::Isometry3d before = kinematics.optical(emulator_.arm().position());
  enable();
  run(2.0, 0.05);
  run(1.0);
  const Eigen::Isometry3d motion = before.inverse() * kinematics.optical(emulator_.arm().position());
  EXPECT_NEAR(motion.linear()(0, 2), std::sin(0.05 * 2.2), 0.012);  // two seconds and the time out of the last command
  EXPECT_NEAR(motion.linear()(1, 2), 0.0, 2e-3);
  EXPECT_NEAR(kinematics.leverArm(emulator_.arm().position(), DriverConfig().insertion_point), 0.2, 1e-3);
}

TEST_P(DriverTest, nothingMovesBeforeEnable) {
  const JointVector before = emulator_.arm().position();
  run(2.0, 0.05);
  EXPECT_EQ(emulator_.arm().position(), before);
}

TEST_P(DriverTest, commandsFromBeforeTheConfirmationMoveNothing) {
  const JointVector before = emulator_.arm().position();
  run(0.5);
  ASSERT_EQ(driver_.enable(kStampOffset + now_, now_), "");
  for (int tick = 0; tick < 200 && mode() != OperatingMode::kEnabled; ++tick) {
    run(kTick);
    if (mode() != OperatingMode::kEnabled) {
      EXPECT_EQ(command({0.05, 0.0, 0.0, 0.0}), "");
    }
  }
  ASSERT_EQ(mode(), OperatingMode::kEnabled);
  run(1.0);
  EXPECT_EQ(emulator_.arm().position(), before);
  run(1.0, 0.05);
  EXPECT_NE(emulator_.arm().position(), before);
}

TEST_P(DriverTest, commandsThatEndStopTheArm) {
  startMoving();
  EXPECT_LT(timeToStand(), kLongestStop);
  EXPECT_EQ(mode(), OperatingMode::kEnabled);
}

TEST_P(DriverTest, aHostThatDiesStopsTheArm) {  // by the controller's time to live alone
  startMoving();
  host_alive_ = false;
  EXPECT_LT(timeToStand(), kLongestStop);
}

TEST_P(DriverTest, aCutLineStopsTheArmAndOnlyEnableMovesItAgain) {
  startMoving();
  cut_ = true;
  EXPECT_LT(timeToStand(0.05), kLongestStop);
  run(1.0, 0.05);
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  cut_ = false;
  const JointVector before = emulator_.arm().position();
  run(2.0, 0.05);
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_EQ(emulator_.arm().position(), before);
  EXPECT_EQ(driver_.enable(kStampOffset + now_, now_), "");
  run(1.0, 0.05);
  EXPECT_TRUE(emulator_.arm().isMoving());
}

TEST_P(DriverTest, notFiniteStopsTheArmAndSaysSo) {
  startMoving();
  EXPECT_NE(command({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0, 0.0}), "");
  run(kTick);
  EXPECT_NE(driver_.state(now_).reason.find("not finite"), std::string::npos);
  EXPECT_LT(timeToStand(), kLongestStop - 0.2 + 0.02);
}

TEST_P(DriverTest, aFaultBrakes) {
  startMoving();
  emulator_.setFaultCause(kFaultEmergencyStop, now_);
  EXPECT_TRUE(emulator_.arm().velocity().isZero(0.0));
  run(0.5, 0.05);
  EXPECT_EQ(mode(), OperatingMode::kFault);
  emulator_.setFaultCause(0, now_);
  EXPECT_EQ(driver_.clearFault(now_), "");
  run(0.5, 0.05);
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_FALSE(emulator_.arm().isMoving());
}

TEST_P(DriverTest, anEmulatorThatRestartsIsNotMovedAgain) {
  startMoving();
  emulator_.reboot(now_);
  const JointVector before = emulator_.arm().position();
  run(2.0, 0.05);
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_EQ(emulator_.arm().position(), before);
}

// A bad line: the arm may stop, but moves only as commanded, and comes back.
TEST_P(DriverTest, badLines) {
  for (const auto& [fault, value] : {std::pair<const char*, const char*>{"drop", "0.002"},
                                     {"corrupt", "0.002"},
                                     {"double", "0.002"},
                                     {"delay", "0.05"}}) {
    SCOPED_TRACE(fault);
    ASSERT_EQ(begin(fault, value), "");
    run(1.0);
    if (mode() != OperatingMode::kEnabled) {
      ASSERT_EQ(driver_.enable(kStampOffset + now_, now_), "");
      run(1.0);
    }
    const int ticks = 1000;
    double fastest = 0.0;
    for (int k = 0; k < ticks; ++k) {
      run(kTick, k % 800 < 400 ? 0.05 : -0.05);
      const scope::Velocity velocity =
          scopeVelocity(driver_.kinematics(), emulator_.arm().position(), emulator_.arm().velocity());
      fastest = std::max({fastest, std::abs(velocity.pan), 3.0 * std::abs(velocity.insertion)});
    }
    EXPECT_LT(fastest, 0.06) << "a damaged frame was taken for a command";
    EXPECT_GT(fastest, 0.03);
    EXPECT_LT(timeToStand(), kLongestStop + 0.3);
    ASSERT_EQ(begin("none"), "");
    run(0.5);
  }
  EXPECT_GT(driver_.session().link().statistics().decoder.crc_errors, 0u);
}

TEST_P(DriverTest, theInsertionPointChangesOnlyWhileDisabledAndAtRest) {
  const Eigen::Vector3d before = driver_.insertionPoint();
  const Eigen::Vector3d other = before + Eigen::Vector3d(0.001, 0.0, 0.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(driver_.setInsertionPoint({nan, 0.0, 0.0}).find("expected finite numbers"), std::string::npos);
  EXPECT_NE(driver_.setInsertionPoint({20.0, 0.0, 0.0}).find("20"), std::string::npos);
  enable();
  EXPECT_NE(driver_.setInsertionPoint(other).find("the arm is ENABLED"), std::string::npos);
  ASSERT_EQ(driver_.pause(), "");
  EXPECT_NE(driver_.setInsertionPoint(other).find("the arm is PAUSED"), std::string::npos);
  ASSERT_EQ(driver_.resume(kStampOffset + now_), "");
  run(1.0, 0.05);
  ASSERT_EQ(driver_.disable(now_), "");
  EXPECT_NE(driver_.setInsertionPoint(other).find("moves"), std::string::npos);
  emulator_.setFaultCause(kFaultMotor, now_);
  run(1.0);
  EXPECT_NE(driver_.setInsertionPoint(other).find("the arm is FAULT"), std::string::npos);
  EXPECT_EQ(driver_.insertionPoint(), before);
  emulator_.setFaultCause(0, now_);
  ASSERT_EQ(driver_.clearFault(now_), "");
  run(0.3);
  EXPECT_EQ(driver_.setInsertionPoint(other), "");
  EXPECT_EQ(driver_.insertionPoint(), other);
}

TEST_P(DriverTest, slowedAtTheDepthWithItsReason) {
  enable();
  for (int k = 0; k < 800; ++k) {
    command({0.0, 0.0, 0.0, 0.02});
    run(0.025);
  }
  EXPECT_NE(driver_.state(now_).reason.find("greatest depth"), std::string::npos) << driver_.state(now_).reason;
  const double d1 = driver_.kinematics().leverArm(emulator_.arm().position(), DriverConfig().insertion_point);
  EXPECT_LE(0.30 - d1, KinematicsConfig().depth_maximum + 1e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Formats, DriverTest,
    ::testing::Values(NamedFormat{"own", makeOwnCodec},
                      NamedFormat{"lines", [] { return std::unique_ptr<Codec>(std::make_unique<LineCodec>()); }}),
    [](const ::testing::TestParamInfo<NamedFormat>& format) { return std::string(format.param.name); });

TEST(Driver, refusesAWrongConfiguration) {
  EXPECT_TRUE(validate(DriverConfig()).empty());
  DriverConfig config;
  config.command.timeout = -1.0;
  config.session.rate = 0.0;
  config.insertion_point.x() = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::string> errors = validate(config);
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_EQ(errors[0].rfind("command/timeout", 0), 0u);
  EXPECT_EQ(errors[1].rfind("link/rate", 0), 0u);
  EXPECT_EQ(errors[2].rfind("insertion_point", 0), 0u);
  EXPECT_THROW(Driver{config}, std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::aesop
