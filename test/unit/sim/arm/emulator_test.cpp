#include "laparoscope_servo/sim/emulator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "aesop/protocol/own_codec.h"

namespace laparoscope_servo::sim {
namespace {

using namespace aesop;

class EmulatorTest : public ::testing::Test {
 protected:
  Status ask(const Message& request) { return ask(request, ++sequence_); }
  Status ask(const Message& request, std::uint16_t sequence) {
    const Bytes bytes = encode({sequence, request});
    const std::vector<Frame> replies = host_.push(emulator_.receive(bytes.data(), bytes.size(), now_));
    if (replies.size() != 1 || !std::holds_alternative<Status>(replies[0].message)) {
      ADD_FAILURE() << "expected exactly one status";
      return {};
    }
    return std::get<Status>(replies[0].message);
  }
  Identity identify() {
    const Bytes bytes = encode({++sequence_, Identify()});
    return std::get<Identity>(host_.push(emulator_.receive(bytes.data(), bytes.size(), now_)).at(0).message);
  }
  void enable() {
    identify();
    ASSERT_EQ(ask(Enable()).state, RobotState::kEnabled);
  }
  // A host that is there, and asks for nothing but the status.
  void wait(double seconds) {
    const double end = now_ + seconds;
    while (now_ + 0.1 < end) {
      emulator_.step(now_ += 0.1);
      ask(Poll());
    }
    emulator_.step(now_ = end);
  }
  void silence(double seconds) { emulator_.step(now_ += seconds); }

  static Velocity up(double time_to_live = 0.2) { return {{0.01, 0.0, 0.0, 0.0}, time_to_live}; }

  double now_ = 10.0;
  std::uint16_t sequence_ = 100;
  Decoder host_;
  Emulator emulator_{EmulatorConfig(), 10.0};
};

TEST_F(EmulatorTest, saysWhoItIs) {
  const Identity identity = identify();
  EXPECT_EQ(identity.joints, 7);
  EXPECT_EQ(identity.driven, 0x47);
}

TEST_F(EmulatorTest, statusTellsTheTruth) {
  identify();
  wait(1.5);
  const Status status = ask(Poll());
  EXPECT_EQ(status.state, RobotState::kDisabled);
  EXPECT_TRUE(status.homed);
  EXPECT_EQ(status.echo, sequence_);
  EXPECT_NEAR(status.time, 1.5, 1e-3);
  EXPECT_LT((status.position - emulator_.arm().position()).norm(), 1e-5);
}

TEST_F(EmulatorTest, withoutASessionNothingIsExecuted) {
  EXPECT_EQ(ask(Enable()).state, RobotState::kDisabled);
}

TEST_F(EmulatorTest, velocityNeedsEnable) {
  identify();
  ask(up());
  wait(1.0);
  EXPECT_EQ(emulator_.arm().position()[0], 0.25);
  EXPECT_EQ(ask(Enable()).state, RobotState::kEnabled);
  ask(up());
  wait(1.0);
  EXPECT_GT(emulator_.arm().position()[0], 0.251);
}

TEST_F(EmulatorTest, velocityRunsOutByItself) {
  enable();
  ask(up(0.3));
  wait(2.0);
  EXPECT_FALSE(emulator_.arm().isMoving());
  EXPECT_NEAR(emulator_.arm().position()[0], 0.25 + 0.01 * 0.3, 2e-4);
  EXPECT_EQ(emulator_.state(), RobotState::kEnabled);
}

TEST_F(EmulatorTest, aSilentHostDisables) {
  enable();
  ask(up(2.0));
  silence(5.0);  // one long step: the silence grows too long within it
  EXPECT_EQ(emulator_.state(), RobotState::kDisabled);
  EXPECT_FALSE(emulator_.arm().isMoving());
  EXPECT_NEAR(emulator_.arm().position()[0], 0.25 + 0.01 * kHostTimeout, 2e-4);
  const double stood = emulator_.arm().position()[0];
  ask(up(2.0));  // what a line held back
  wait(1.0);
  EXPECT_EQ(emulator_.arm().position()[0], stood);
}

TEST_F(EmulatorTest, aJammedJointStandsAndTheOthersMove) {
  enable();
  emulator_.jam(0, now_);
  ask(Velocity{{0.01, 0.02, 0.0, 0.0}, 0.5});
  wait(1.0);
  EXPECT_EQ(emulator_.arm().position()[0], 0.25);
  EXPECT_GT(emulator_.arm().position()[1], -0.9 + 0.005);
  EXPECT_EQ(emulator_.faults(), 0);
  emulator_.jam(-1, now_);
  ask(up());
  wait(1.0);
  EXPECT_GT(emulator_.arm().position()[0], 0.251);
}

TEST_F(EmulatorTest, recordsHowLongTheMotorsMove) {
  enable();
  EXPECT_EQ(emulator_.longestMotion(), 0.0);
  ask(up(0.3));
  wait(2.0);
  EXPECT_GT(emulator_.longestMotion(), 0.3 + 0.16);
  EXPECT_LT(emulator_.longestMotion(), 0.3 + 0.16 + 0.15);
}

TEST_F(EmulatorTest, lies) {
  enable();
  ask(up(2.0));
  wait(0.5);
  const auto told = [&](const char* lie) {
    emulator_.lie(*lieNamed(lie), now_);
    now_ += 0.05;
    return ask(Poll());
  };
  EXPECT_EQ(told("disabled").state, RobotState::kDisabled);
  EXPECT_EQ(told("enabled").state, RobotState::kEnabled);
  EXPECT_TRUE(told("standing").velocity.isZero(0.0));
  EXPECT_FALSE(told("standing").moving);
  const double frozen = told("none").position[0];
  EXPECT_NEAR(told("frozen").position[0], frozen, 1e-5);
  EXPECT_GT(std::abs(told("none").position[0] - frozen), 1e-4);
  const double jumped = told("jumped").position[0];
  EXPECT_NEAR(jumped, emulator_.arm().position()[0] + 0.2, 1e-5);
  EXPECT_NE(told("echo_frozen").echo, sequence_);
  EXPECT_GT(compareSequence(told("echo_ahead").echo, sequence_), 0);
  emulator_.setFaultCause(kFaultMotor, now_);
  EXPECT_EQ(told("healthy").faults, 0);
  EXPECT_EQ(told("healthy").state, RobotState::kEnabled);
  EXPECT_TRUE(told("moving").moving);
  EXPECT_EQ(told("none").faults, kFaultMotor);
  EXPECT_FALSE(lieNamed("white"));
}

TEST_F(EmulatorTest, stopDisableAndIdentifyStop) {
  for (int how = 0; how < 3; ++how) {
    enable();
    ask(up(2.0));
    wait(0.5);
    ASSERT_TRUE(emulator_.arm().isMoving());
    if (how == 0) ask(Stop());
    if (how == 1) {
      EXPECT_EQ(ask(Disable()).state, RobotState::kDisabled);
    }
    if (how == 2) identify();
    EXPECT_EQ(emulator_.state(), how == 0 ? RobotState::kEnabled : RobotState::kDisabled);
    wait(0.5);
    EXPECT_FALSE(emulator_.arm().isMoving());
  }
}

TEST_F(EmulatorTest, enableWaitsForRest) {
  enable();
  ask(up());
  wait(0.18);
  ask(Disable());
  EXPECT_EQ(ask(Enable()).state, RobotState::kDisabled) << "it still moves";
  wait(1.0);
  EXPECT_EQ(ask(Enable()).state, RobotState::kEnabled);
}

TEST_F(EmulatorTest, doubledAndLateRequestsDoNothing) {
  enable();
  ask(up());
  const std::uint16_t velocity = sequence_;
  const std::uint16_t enabled = static_cast<std::uint16_t>(sequence_ - 1);
  ask(Disable());
  wait(2.0);
  EXPECT_EQ(ask(Enable(), enabled).state, RobotState::kDisabled) << "an old enable";
  EXPECT_EQ(ask(Enable(), sequence_).state, RobotState::kDisabled) << "a number that was taken already";
  ask(Enable());
  const JointVector before = emulator_.arm().position();
  EXPECT_EQ(ask(up(), velocity).echo, sequence_);
  wait(1.0);
  EXPECT_EQ(emulator_.arm().position(), before);
}

TEST_F(EmulatorTest, faultsBrakeAndStay) {
  enable();
  ask(up(2.0));
  wait(0.5);
  emulator_.setFaultCause(kFaultMotor, now_);
  EXPECT_FALSE(emulator_.arm().isMoving());
  Status status = ask(ClearFault());
  EXPECT_EQ(status.state, RobotState::kFault) << "the cause is still there";
  EXPECT_EQ(status.faults, kFaultMotor);
  emulator_.setFaultCause(0, now_);
  EXPECT_EQ(ask(Enable()).state, RobotState::kFault);
  identify();
  EXPECT_EQ(ask(Poll()).state, RobotState::kFault) << "a new session does not clear it";
  status = ask(ClearFault());
  EXPECT_EQ(status.state, RobotState::kDisabled);
  EXPECT_EQ(status.faults, 0);
}

TEST_F(EmulatorTest, rebootForgetsTheSession) {
  enable();
  ask(up(2.0));
  wait(0.5);
  emulator_.reboot(now_);
  EXPECT_FALSE(emulator_.arm().isMoving());
  const Status status = ask(Enable());
  EXPECT_EQ(status.state, RobotState::kDisabled);
  EXPECT_NEAR(status.time, 0.0, 1e-3);
}

TEST_F(EmulatorTest, handOnlyWhileDisabled) {
  enable();
  EXPECT_NE(emulator_.hand({0.1, 0.0, 0.0, 0.0}, 1.0, now_).find("ENABLED"), std::string::npos);
  ask(Disable());
  EXPECT_EQ(emulator_.hand({0.1, 0.0, 0.0, 0.0}, 1.0, now_), "");
  EXPECT_EQ(ask(Enable()).state, RobotState::kDisabled) << "a hand is on the arm";
  wait(2.0);
  EXPECT_EQ(ask(Enable()).state, RobotState::kEnabled);
}

TEST_F(EmulatorTest, garbageIsNotAnswered) {
  const Bytes garbage(500, 0xA5);
  EXPECT_TRUE(emulator_.receive(garbage.data(), garbage.size(), now_).empty());
  identify();
}

TEST(EmulatorConfig, errorsNameTheirGroup) {
  EXPECT_TRUE(validate(EmulatorConfig()).empty());
  EmulatorConfig config;
  config.kinematics.scope_length = 0.0;
  config.arm.delay = 5.0;
  const std::vector<std::string> errors = validate(config);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(errors[0].rfind("kinematics/scope_length", 0), 0u);
  EXPECT_EQ(errors[1].rfind("emulator/delay", 0), 0u);
}

}  // namespace
}  // namespace laparoscope_servo::sim
