#include "ros/common/state_report.h"

#include <gtest/gtest.h>

#include "laparoscope_servo/aesop/driver.h"
#include "laparoscope_servo/sim/emulator.h"

namespace laparoscope_servo {
namespace {

using aesop::OperatingMode;

// A driver and an emulated controller, and what the screen would show.
class StateReportTest : public ::testing::Test {
 protected:
  void step() {
    now_ += 0.005;
    const aesop::Bytes to = driver_.transmit(now_);
    emulator_.step(now_);
    if (connected_) {
      const aesop::Bytes from = emulator_.receive(to.data(), to.size(), now_);
      driver_.receive(from.data(), from.size(), now_);
    }
    if (const auto line = report_.take(driver_.state(now_), driver_.session(), now_)) lines_.push_back(*line);
  }
  void run(double seconds) {
    for (const double end = now_ + seconds; now_ < end;) step();
  }
  StateLine last() const { return lines_.empty() ? StateLine() : lines_.back(); }

  aesop::Driver driver_{aesop::DriverConfig()};
  double now_ = 100.0;
  sim::Emulator emulator_{sim::EmulatorConfig(), now_};
  StateReport report_;
  std::vector<StateLine> lines_;
  bool connected_ = true;
};

TEST_F(StateReportTest, aStartWithoutAProblemIsNoProblem) {
  driver_.opened(now_);
  run(2.0);
  ASSERT_EQ(lines_.size(), 1u) << last().text;
  EXPECT_EQ(last().text, "DISABLED: not enabled yet");
  EXPECT_EQ(last().severity, Severity::kInfo);
}

TEST_F(StateReportTest, eachReasonComesAtItsLevel) {
  driver_.closed("no such port");
  run(0.1);
  EXPECT_EQ(last().text, "DISABLED: not connected: no such port; trying again");
  EXPECT_EQ(last().severity, Severity::kError);
  driver_.opened(now_);
  run(0.5);
  ASSERT_EQ(driver_.enable(now_, now_), "");
  run(0.5);
  EXPECT_EQ(last().text, "ENABLED");
  EXPECT_EQ(last().severity, Severity::kInfo);
  driver_.pause("somebody waits");
  run(0.1);
  EXPECT_EQ(last().text, "PAUSED: somebody waits");
  EXPECT_EQ(last().severity, Severity::kWarning);
  driver_.resume(now_);
  run(0.1);
  driver_.disable(now_);
  run(0.5);
  EXPECT_EQ(last().text, "DISABLED: disabled on request");
  EXPECT_EQ(last().severity, Severity::kInfo);
  driver_.stop(now_, "stopped by /somebody");
  run(0.5);
  EXPECT_EQ(last().text, "DISABLED: stopped by /somebody");
  EXPECT_EQ(last().severity, Severity::kWarning);
  connected_ = false;
  run(1.0);
  EXPECT_NE(last().text.find("not connected: the controller has sent no status"), std::string::npos) << last().text;
  EXPECT_EQ(last().severity, Severity::kError);
}

TEST_F(StateReportTest, aControllerThatDoesNotAnswerIsSaidAfterASecond) {
  connected_ = false;
  driver_.opened(now_);
  run(0.9);
  EXPECT_TRUE(lines_.empty()) << last().text;
  run(0.5);
  ASSERT_EQ(lines_.size(), 1u);
  EXPECT_NE(last().text.find("check its power"), std::string::npos);
  EXPECT_EQ(last().severity, Severity::kError);
}

// It had said "check its power" for ever.
TEST(StateReport, wrongJointsReplaceTheAdviceToCheckThePower) {
  aesop::SessionConfig config;
  aesop::Session session(config, 0x47);
  StateReport report;
  session.opened(0.0);
  EXPECT_FALSE(report.take(session.state(), session, 0.0));
  const auto power = report.take(session.state(), session, 1.5);
  ASSERT_TRUE(power);
  EXPECT_NE(power->text.find("check its power"), std::string::npos);
  const aesop::Bytes identity = config.codec()->encode({1, aesop::Identity{6, 0x3f, "other"}});
  session.receive(identity.data(), identity.size(), 1.6);
  const auto joints = report.take(session.state(), session, 1.6);
  ASSERT_TRUE(joints);
  EXPECT_NE(joints->text.find("6 joints"), std::string::npos) << joints->text;
  EXPECT_EQ(joints->severity, Severity::kError);
}

TEST_F(StateReportTest, theEmergencyStopIsAnError) {
  driver_.opened(now_);
  run(0.5);
  ASSERT_EQ(driver_.enable(now_, now_), "");
  run(0.5);
  emulator_.setFaultCause(aesop::kFaultEmergencyStop, now_);
  run(0.5);
  EXPECT_EQ(last().text.rfind("FAULT: fault: ", 0), 0u) << last().text;
  EXPECT_EQ(last().severity, Severity::kError);
}

}  // namespace
}  // namespace laparoscope_servo
