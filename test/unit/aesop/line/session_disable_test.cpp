// The way back to DISABLED: repeated until the controller confirms it, whatever it said before.
#include <gtest/gtest.h>

#include "laparoscope_servo/aesop/session.h"
#include "unit/aesop/session_fixture.h"

namespace laparoscope_servo::aesop {
namespace {

TEST_F(SessionTest, disableGoesOutAtOnceAndUntilConfirmed) {
  connect();
  enable();
  ASSERT_TRUE(sends<Velocity>(kMove));
  EXPECT_EQ(session_.disable(now_), "");
  now_ += 0.001;
  EXPECT_TRUE(std::holds_alternative<Disable>(controller_.hear(session_.transmit(kMove, now_)).at(0)));
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_TRUE(session_.state().is_busy);
  EXPECT_TRUE(sends<Disable>(kMove));
  controller_.status.state = RobotState::kDisabled;
  EXPECT_TRUE(sends<Disable>(kMove));
  EXPECT_TRUE(sends<Poll>(kMove));
  EXPECT_FALSE(session_.state().is_busy);
}

TEST_F(SessionTest, aControllerThatDisablesItselfIsNotEnabledAgain) {
  connect();
  enable();
  controller_.status.state = RobotState::kDisabled;
  exchange(kMove);
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_NE(session_.state().reason.find("disabled itself"), std::string::npos);
  EXPECT_TRUE(sends<Disable>(kMove)) << "it may say so and not do so";
  for (int k = 0; k < 10; ++k) EXPECT_TRUE(sends<Poll>(kMove));
}

TEST_F(SessionTest, disableIsRepeatedUntilTheArmStands) {
  connect();
  enable();
  ASSERT_TRUE(sends<Velocity>(kMove));
  session_.giveUp("joint 3 does not follow");
  controller_.status.state = RobotState::kDisabled;
  controller_.status.moving = true;
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(sends<Disable>(kMove));
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_TRUE(session_.state().is_busy);
  EXPECT_EQ(session_.enable(now_), "") << "it is under way, but waits for that";
  EXPECT_TRUE(sends<Disable>(kMove));
  controller_.status.moving = false;
  EXPECT_TRUE(sends<Disable>(kMove));
  EXPECT_TRUE(sends<Enable>(kMove));
}

// It has disabled itself while it moved, is to be enabled as soon as it stands, and says that it is enabled before.
TEST_F(SessionTest, whatWasNotAskedForYetIsNotConfirmed) {
  connect();
  enable();
  ASSERT_TRUE(sends<Velocity>(kMove));
  session_.giveUp("a test");
  controller_.status.state = RobotState::kDisabled;
  controller_.status.moving = true;
  EXPECT_TRUE(sends<Disable>(kMove));
  ASSERT_EQ(session_.enable(now_), "");
  controller_.status.state = RobotState::kEnabled;
  for (int k = 0; k < 5; ++k) {
    EXPECT_TRUE(sends<Disable>(kMove));
    EXPECT_EQ(mode(), OperatingMode::kDisabled);
  }
  controller_.status.state = RobotState::kDisabled;
  controller_.status.moving = false;
  EXPECT_TRUE(sends<Disable>(kMove));
  EXPECT_TRUE(sends<Enable>(kMove, false));
  controller_.status.state = RobotState::kEnabled;
  EXPECT_TRUE(sends<Enable>(kMove));
  EXPECT_TRUE(sends<Velocity>(kMove));
}

TEST_F(SessionTest, aDisableIsNotConfirmedByWhatWasSaidBefore) {
  connect();
  enable();
  ASSERT_TRUE(sends<Velocity>(kMove));
  controller_.status.state = RobotState::kDisabled;
  const Bytes before = controller_.say();
  session_.giveUp("a test");
  session_.receive(before.data(), before.size(), now_);
  EXPECT_TRUE(sends<Disable>(kMove));
}

TEST_F(SessionTest, aDisableThatIsNotConfirmedIsReported) {
  connect();
  enable();
  EXPECT_FALSE(session_.stopped());
  EXPECT_EQ(session_.disable(now_), "");
  for (int k = 0; k < 30; ++k) EXPECT_TRUE(sends<Disable>()) << "it stays ENABLED";
  EXPECT_FALSE(session_.stopped());
  for (int k = 0; k < 30; ++k) EXPECT_TRUE(sends<Disable>());
  EXPECT_TRUE(session_.stopped());
  EXPECT_NE(session_.state().reason.find("does not confirm"), std::string::npos) << session_.state().reason;
  controller_.status.state = RobotState::kDisabled;
  sends<Disable>();
  EXPECT_FALSE(session_.state().is_busy);
  EXPECT_EQ(session_.state().reason.find("does not confirm"), std::string::npos) << session_.state().reason;
}

// Identification goes on, and its numbers with it, until they look older than the disable.
TEST_F(SessionTest, anHourWithoutAnAnswerLeavesNothingToConfirm) {
  connect();
  enable();
  session_.closed("a test");
  session_.opened(now_);
  for (int k = 0; k < 40000; ++k) {
    now_ += 0.2;
    session_.transmit(kStand, now_);
  }
  for (int k = 0; k < 20; ++k) exchange(kStand);
  EXPECT_TRUE(session_.link().isUp());
  EXPECT_FALSE(session_.state().is_busy);
  enable();
}

// A request is nothing to warn of, a stop is.
TEST_F(SessionTest, aStopIsADisableWithAReason) {
  connect();
  enable();
  EXPECT_EQ(session_.disable(now_), "");
  EXPECT_FALSE(session_.stopped());
  EXPECT_EQ(session_.state().reason, "disabled on request");
  controller_.status.state = RobotState::kDisabled;
  exchange(kMove);
  exchange(kMove);
  enable();
  ASSERT_TRUE(sends<Velocity>(kMove));
  EXPECT_EQ(session_.stop(now_, "stopped by /somebody"), "");
  EXPECT_TRUE(session_.stopped());
  EXPECT_FALSE(session_.isUnconfirmed());
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_EQ(session_.state().reason, "stopped by /somebody");
  for (int k = 0; k < 200 && !session_.isUnconfirmed(); ++k) EXPECT_TRUE(sends<Disable>(kMove));
  EXPECT_TRUE(session_.isUnconfirmed()) << "the controller goes on saying ENABLED";
  EXPECT_TRUE(session_.stopped());
}

TEST_F(SessionTest, anArmThatLosesItsHomingIsDisabled) {
  connect();
  enable();
  ASSERT_TRUE(sends<Velocity>(kMove));
  controller_.status.homed = false;
  exchange(kMove);
  EXPECT_EQ(mode(), OperatingMode::kDisabled);
  EXPECT_TRUE(session_.stopped());
  EXPECT_NE(session_.state().reason.find("homing"), std::string::npos) << session_.state().reason;
  EXPECT_TRUE(sends<Disable>(kMove));
}

}  // namespace
}  // namespace laparoscope_servo::aesop
