#include "laparoscope_servo/aesop/session.h"

#include <gtest/gtest.h>

#include <limits>

#include "unit/aesop/session_fixture.h"

namespace laparoscope_servo::aesop {
namespace {

TEST_F(SessionTest, startsDisabledAndSaysWhy) {
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_NE(session_.state().reason.find("not connected"), std::string::npos);
  EXPECT_NE(session_.enable(0.0), "");
  connect();
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_TRUE(session_.state().is_homed);
}

TEST_F(SessionTest, noVelocityUnlessEnabled) {
  connect();
  for (int k = 0; k < 20; ++k) EXPECT_TRUE(sends<Poll>(kMove));
}

TEST_F(SessionTest, enableIsRepeatedUntilConfirmed) {
  connect();
  ASSERT_EQ(session_.enable(now_), "");
  for (int k = 0; k < 5; ++k) {
    EXPECT_TRUE(sends<Enable>(kMove));
    EXPECT_EQ(mode(), OperatingMode::kDisabled);
    EXPECT_TRUE(session_.state().is_busy);
  }
  controller_.status.state = RobotState::kEnabled;
  EXPECT_TRUE(sends<Enable>());
  EXPECT_EQ(mode(), OperatingMode::kEnabled);
  EXPECT_EQ(session_.state().reason, "");
  const std::optional<Message> request = exchange(kMove);
  ASSERT_TRUE(request && std::holds_alternative<Velocity>(*request));
  EXPECT_DOUBLE_EQ(std::get<Velocity>(*request).speed[0], 0.01);
  EXPECT_DOUBLE_EQ(std::get<Velocity>(*request).time_to_live, SessionConfig().time_to_live);
}

TEST_F(SessionTest, enableThatIsNotConfirmedEndsInDisabled) {
  connect();
  ASSERT_EQ(session_.enable(now_), "");
  for (int k = 0; k < 45; ++k) exchange(kMove);
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_NE(session_.state().reason.find("not confirmed"), std::string::npos);
  controller_.status.state = RobotState::kEnabled;  // too late
  exchange(kMove);
  EXPECT_TRUE(sends<Disable>(kMove));
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
}

TEST_F(SessionTest, anEnabledControllerNobodyAskedForIsDisabled) {
  connect();
  controller_.status.state = RobotState::kEnabled;
  exchange(kMove);
  EXPECT_TRUE(sends<Disable>(kMove));
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_NE(session_.enable(now_), "") << "it has to come from DISABLED";
}

TEST_F(SessionTest, stopGoesOutAtOnceAndUntilConfirmed) {
  connect();
  enable();
  controller_.status.moving = true;
  ASSERT_TRUE(sends<Velocity>(kMove));
  now_ += 0.001;  // long before the next slot
  const std::vector<Message> requests = controller_.hear(session_.transmit(kStand, now_));
  ASSERT_EQ(requests.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<Stop>(requests[0]));
  for (int k = 0; k < 8; ++k) EXPECT_TRUE(sends<Stop>()) << "it still moves";
  controller_.status.moving = false;
  EXPECT_TRUE(sends<Stop>());
  EXPECT_TRUE(sends<Poll>());
}

TEST_F(SessionTest, aStatusOfBeforeTheStopConfirmsNothing) {
  connect();
  enable();
  ASSERT_TRUE(sends<Velocity>(kMove));
  const Bytes earlier = controller_.say();  // standing, but an echo of the velocity
  ASSERT_TRUE(sends<Stop>(kStand, false));
  session_.receive(earlier.data(), earlier.size(), now_);
  EXPECT_TRUE(sends<Stop>());
  EXPECT_TRUE(sends<Poll>());
}

TEST_F(SessionTest, whatCannotBeSentIsAStop) {
  connect();
  enable();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, std::numeric_limits<double>::infinity(), 1e9}) {
    ASSERT_TRUE(sends<Velocity>(kMove));
    EXPECT_TRUE(sends<Stop>({bad, 0.01, 0.0, 0.0}));
    exchange(kStand);
  }
}

TEST_F(SessionTest, pauseStopsAndStaysEnabled) {
  EXPECT_NE(session_.pause(), "");
  EXPECT_NE(session_.resume(), "");
  connect();
  enable();
  ASSERT_TRUE(sends<Velocity>(kMove));
  EXPECT_EQ(session_.pause(), "");
  EXPECT_EQ(mode(), OperatingMode::kPaused);
  EXPECT_TRUE(sends<Stop>(kMove));
  EXPECT_TRUE(sends<Poll>(kMove));
  EXPECT_EQ(session_.resume(), "");
  EXPECT_TRUE(sends<Velocity>(kMove));
}

TEST_F(SessionTest, aFaultEndsTheEnableAndClearsToDisabled) {
  connect();
  enable();
  ASSERT_TRUE(sends<Velocity>(kMove));
  controller_.status.state = RobotState::kFault;
  controller_.status.faults = kFaultMotor;
  exchange(kMove);
  EXPECT_EQ(mode(), OperatingMode::kFault);
  EXPECT_EQ(session_.state().reason, "fault: motor");
  EXPECT_NE(session_.enable(now_), "");
  EXPECT_FALSE(sends<Velocity>(kMove));
  EXPECT_EQ(session_.clearFault(now_), "");
  EXPECT_TRUE(sends<ClearFault>(kMove));
  controller_.status.state = RobotState::kDisabled;
  controller_.status.faults = 0;
  EXPECT_TRUE(sends<ClearFault>(kMove));
  EXPECT_TRUE(sends<Poll>(kMove));
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_NE(session_.clearFault(now_), "") << "there is none any more";
  enable();
  EXPECT_TRUE(sends<Velocity>(kMove));
}

TEST_F(SessionTest, aFaultThatCannotBeClearedSaysSo) {
  connect();
  controller_.status.state = RobotState::kFault;
  controller_.status.faults = kFaultEmergencyStop;
  exchange(kStand);
  ASSERT_EQ(session_.clearFault(now_), "");
  for (int k = 0; k < 45; ++k) exchange(kStand);
  EXPECT_EQ(mode(), OperatingMode::kFault);
  EXPECT_FALSE(session_.state().is_busy);
  EXPECT_NE(session_.state().reason.find("could not be cleared"), std::string::npos);
  exchange(kStand);
  EXPECT_NE(session_.state().reason.find("emergency stop"), std::string::npos);
}

TEST_F(SessionTest, unknownFaultBitsAreAFaultWhateverTheState) {
  connect();
  enable();
  controller_.status.faults = 0x8000;  // still saying ENABLED
  exchange(kMove);
  EXPECT_EQ(mode(), OperatingMode::kFault);
  EXPECT_TRUE(sends<Disable>(kMove));
}

TEST_F(SessionTest, silenceLeadsToDisabledAndBackOnlyByEnable) {
  connect();
  enable();
  ASSERT_TRUE(sends<Velocity>(kMove));
  bool identifies = false;
  for (int k = 0; k < 30 && !identifies; ++k) identifies = sends<Identify>(kMove, false);
  EXPECT_TRUE(identifies);
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_NE(session_.state().reason.find("no status"), std::string::npos);
  now_ += 0.2;
  ASSERT_TRUE(sends<Identify>(kMove));
  for (int k = 0; k < 20; ++k) EXPECT_TRUE(sends<Poll>(kMove));
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_NE(session_.state().reason.find("no status"), std::string::npos) << "the reason outlives the repair";
  enable();
  EXPECT_TRUE(sends<Velocity>(kMove));
}

TEST_F(SessionTest, aPortThatGoesAwayLeadsToDisabled) {
  connect();
  enable();
  session_.closed("cable pulled");
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_NE(session_.state().reason.find("cable pulled"), std::string::npos);
  EXPECT_TRUE(session_.transmit(kMove, now_ + 1.0).empty());
  now_ += 1.0;
  connect();
  for (int k = 0; k < 20; ++k) EXPECT_TRUE(sends<Poll>(kMove));
}

TEST_F(SessionTest, aRestartedControllerIsNotEnabledAgain) {
  controller_.status.time = 50.0;
  connect();
  enable();
  controller_.status.time = 0.0;
  exchange(kMove);
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_NE(session_.state().reason.find("restarted"), std::string::npos);
  EXPECT_TRUE(sends<Identify>(kMove));
}

// Its identity may come with the same bytes: the answer to an Identify that the line has held back or doubled.
TEST_F(SessionTest, aRestartWithinOneReadEndsTheEnable) {
  for (const bool moving : {false, true}) {
    controller_.status = FakeController().status;
    controller_.status.echo = session_.link().sequence();
    controller_.status.time = 50.0;
    session_.closed("a test");
    connect();
    enable();
    ASSERT_TRUE(sends<Velocity>(kMove));
    controller_.status.time = 0.0;
    controller_.status.moving = moving;
    Bytes read = controller_.say();
    for (const Bytes& more : {controller_.identity(), controller_.say()}) {
      read.insert(read.end(), more.begin(), more.end());
    }
    session_.receive(read.data(), read.size(), now_);
    ASSERT_TRUE(session_.link().isUp());
    EXPECT_EQ(mode(), OperatingMode::kDisabled);
    EXPECT_TRUE(session_.stopped());
    EXPECT_NE(session_.state().reason.find("restarted"), std::string::npos) << session_.state().reason;
    for (int k = 0; k < 5; ++k) EXPECT_TRUE(sends<Disable>(kMove)) << "it still says ENABLED";
    controller_.status.state = RobotState::kDisabled;
    controller_.status.moving = false;
    EXPECT_TRUE(sends<Disable>(kMove));
    for (int k = 0; k < 5; ++k) EXPECT_TRUE(sends<Poll>(kMove));
    EXPECT_EQ(mode(), OperatingMode::kDisabled);
  }
}

// Some other fault is another reason, also where its words begin those of the one before.
TEST_F(SessionTest, theReasonIsTheFaultThatThereIs) {
  connect();
  controller_.status.state = RobotState::kFault;
  controller_.status.faults = kFaultEmergencyStop | kFaultMotor;
  exchange(kStand);
  EXPECT_EQ(session_.state().reason, "fault: " + describeFaults(kFaultEmergencyStop | kFaultMotor));
  controller_.status.faults = kFaultEmergencyStop;
  exchange(kStand);
  EXPECT_EQ(session_.state().reason, "fault: " + describeFaults(kFaultEmergencyStop));
  controller_.status.state = RobotState::kDisabled;
  controller_.status.faults = 0;
  exchange(kStand);
  EXPECT_EQ(session_.state().reason, "the fault has gone by itself");
}

// What somebody gives as a reason has no meaning but for who reads it.
TEST_F(SessionTest, wordsDecideNothing) {
  connect();
  enable();
  EXPECT_EQ(session_.stop(now_, "the controller does not confirm the disable"), "");
  EXPECT_FALSE(session_.isUnconfirmed());
  controller_.status.state = RobotState::kDisabled;
  exchange(kStand);
  EXPECT_EQ(session_.state().reason, "the controller does not confirm the disable");
  EXPECT_EQ(session_.stop(now_, "fault: /node"), "");
  exchange(kStand);
  EXPECT_EQ(session_.state().reason, "fault: /node");
}

TEST_F(SessionTest, anArmThatIsNotHomedIsNotEnabled) {
  controller_.status.homed = false;
  connect();
  EXPECT_NE(session_.enable(now_).find("homed"), std::string::npos);
}

}  // namespace
}  // namespace laparoscope_servo::aesop
