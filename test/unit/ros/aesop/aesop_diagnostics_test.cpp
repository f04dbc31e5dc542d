#include "ros/aesop/aesop_diagnostics.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <cstdlib>
#include <limits>

#include "laparoscope_servo/sim/emulator.h"

namespace laparoscope_servo {
namespace {

using diagnostic_msgs::DiagnosticStatus;

class AesopDiagnosticsTest : public ::testing::Test {
 protected:
  // Lets `seconds` pass on a line without faults; a pan is commanded when it is not zero.
  void run(double seconds, double pan = 0.0) {
    const double end = now_ + seconds;
    while (now_ < end - 1e-9) {
      now_ += 0.005;
      if (pan != 0.0) driver_.command({pan, 0.0, 0.0, 0.0}, 1000.0 + now_, 1000.0 + now_, now_);
      const aesop::Bytes requests = driver_.transmit(now_);
      const aesop::Bytes replies = emulator_.receive(requests.data(), requests.size(), now_);
      driver_.receive(replies.data(), replies.size(), now_);
    }
  }
  void enable() {
    driver_.opened(now_);
    run(0.5);
    ASSERT_EQ(driver_.enable(1000.0 + now_, now_), "");
    run(0.3);
  }
  diagnostic_updater::DiagnosticStatusWrapper filled(std::uint32_t publishers = 1) {
    diagnostic_updater::DiagnosticStatusWrapper status;
    diagnostics_.fill(now_, driver_, {master_, publishers, 2.5}, status);
    return status;
  }
  static std::string value(const DiagnosticStatus& status, const std::string& key) {
    for (const auto& pair : status.values) {
      if (pair.key == key) return pair.value;
    }
    ADD_FAILURE() << "there is no '" << key << "'";
    return "";
  }
  static double number(const DiagnosticStatus& status, const std::string& key) {
    return std::strtod(value(status, key).c_str(), nullptr);
  }

  double now_ = 100.0;
  aesop::Driver driver_{aesop::DriverConfig()};
  sim::Emulator emulator_{sim::EmulatorConfig(), now_};
  InputOwner master_{"/controller", "commands", "command/publisher"};
  AesopDiagnostics diagnostics_{"/dev/aesop", ""};
};

TEST_F(AesopDiagnosticsTest, aClosedPortIsAnError) {
  driver_.closed("port '/dev/aesop': there is no such port");
  const auto status = filled(0);
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  EXPECT_NE(status.message.find("no such port"), std::string::npos) << status.message;
  EXPECT_EQ(value(status, "link"), "closed");
  EXPECT_NEAR(number(status, "next attempt to open the port [s]"), 2.5, 1e-9);
  EXPECT_EQ(number(status, "requests sent [1/s]"), 0.0);
}

TEST_F(AesopDiagnosticsTest, ratesAreThoseSinceTheLastTime) {
  enable();
  filled();
  run(2.0);
  const auto status = filled();
  EXPECT_EQ(status.level, DiagnosticStatus::OK) << status.message;
  EXPECT_NEAR(number(status, "requests sent [1/s]"), 40.0, 1.0);
  EXPECT_NEAR(number(status, "statuses received [1/s]"), 40.0, 1.0);
  EXPECT_EQ(value(status, "controller"), "EMULATED AESOP");
  EXPECT_LT(number(status, "round trip, 99 of 100 [s]"), 0.006);
  driver_.closed("unplugged");
  now_ += 2.0;
  EXPECT_EQ(number(filled(), "statuses received [1/s]"), 0.0);
}

TEST_F(AesopDiagnosticsTest, measuresTheDelayOfTheArm) {
  enable();
  EXPECT_EQ(value(filled(), "delay of the arm, start to half its speed [s]"), "not measured yet");
  run(1.5, 0.05);
  driver_.command(scope::Velocity(), 1000.0 + now_, 1000.0 + now_, now_);
  run(2.0);
  const auto status = filled();
  const sim::ArmConfig arm;
  for (const char* key :
       {"delay of the arm, start to half its speed [s]", "delay of the arm, stop to half its speed [s]"}) {
    EXPECT_GE(number(status, key), arm.delay) << key;
    EXPECT_LT(number(status, key), arm.delay + arm.time_constant + 0.05) << key;
  }
  EXPECT_GE(number(status, "delay of the arm, stop to standing [s]"),
            number(status, "delay of the arm, stop to half its speed [s]"));
}

TEST_F(AesopDiagnosticsTest, refusedCommandsAreCountedByCause) {
  enable();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double stamp = 1000.0 + now_;
  driver_.command({nan, 0.0, 0.0, 0.0}, stamp, stamp, now_);
  driver_.command({0.01, 0.0, 0.0, 0.0}, 0.0, stamp, now_);
  driver_.command({0.01, 0.0, 0.0, 0.0}, stamp - 10.0, stamp, now_);
  driver_.command({0.01, 0.0, 0.0, 0.0}, stamp, stamp, now_);
  driver_.command({0.01, 0.0, 0.0, 0.0}, stamp, stamp, now_);
  driver_.command({0.01, 0.0, 0.0, 0.0}, stamp + 9.0, stamp, now_);
  // Newer than the last one, and yet more than half a second old.
  driver_.command({0.01, 0.0, 0.0, 0.0}, stamp + 0.6, stamp + 2.0, now_);
  const auto status = filled();
  EXPECT_EQ(number(status, "commands accepted"), 1.0);
  EXPECT_EQ(number(status, "commands refused"), 6.0);
  int causes = 0;
  for (const auto& pair : status.values) {
    if (pair.key.rfind("refused: ", 0) != 0) continue;
    ++causes;
    EXPECT_EQ(pair.value, "1") << pair.key;
  }
  EXPECT_EQ(causes, 6);
}

TEST_F(AesopDiagnosticsTest, strangersAreAWarning) {
  enable();
  EXPECT_EQ(filled(1).level, DiagnosticStatus::OK);
  const auto connected = filled(2);
  EXPECT_EQ(connected.level, DiagnosticStatus::WARN);
  EXPECT_NE(connected.message.find("2 publishers"), std::string::npos) << connected.message;
  master_.judge("/stranger", boost::make_shared<int>(0), now_);
  const auto heard = filled(2);
  EXPECT_EQ(heard.level, DiagnosticStatus::WARN);
  EXPECT_NE(heard.message.find("/stranger"), std::string::npos) << heard.message;
  EXPECT_EQ(number(heard, "commands refused for their sender"), 1.0);
}

}  // namespace
}  // namespace laparoscope_servo
