#include "laparoscope_servo/sim/emulator_control.h"

#include <gtest/gtest.h>

#include <sstream>

namespace laparoscope_servo::sim {
namespace {

class EmulatorControlTest : public ::testing::Test {
 protected:
  std::string ask(const std::string& request) { return answerControl(request, emulator_, faults_, now_); }
  bool refuses(const std::string& request) { return ask(request).rfind("error ", 0) == 0; }
  double now_ = 5.0;
  Emulator emulator_{EmulatorConfig(), 5.0};
  Wire wire_{1};
  Faults faults_{emulator_, wire_};
};

TEST_F(EmulatorControlTest, stateIsTimeAndJoints) {
  now_ = 6.25;
  std::istringstream answer(ask("state"));
  std::string ok;
  double time = 0.0;
  answer >> ok >> time;
  EXPECT_EQ(ok, "ok");
  EXPECT_NEAR(time, 1.25, 1e-9);
  for (int k = 0; k < aesop::kJoints; ++k) {
    double q = 0.0;
    answer >> q;
    EXPECT_NEAR(q, emulator_.arm().position()[k], 1e-11);
  }
  EXPECT_TRUE(answer.good() || answer.eof());
}

TEST_F(EmulatorControlTest, handMoves) {
  EXPECT_EQ(ask("hand 0.1 0 0 0.01 0.5"), "ok");
  EXPECT_EQ(ask("motion").rfind("ok DISABLED 1 0", 0), 0u) << ask("motion");
  EXPECT_TRUE(refuses("hand 0.1 0 0 0.01 0.5")) << "a hand is on it";
  now_ += 1.0;
  EXPECT_EQ(ask("motion").rfind("ok DISABLED 0 0", 0), 0u) << ask("motion");
}

TEST_F(EmulatorControlTest, faults) {
  EXPECT_EQ(ask("fault drop 0.25"), "ok");
  EXPECT_EQ(wire_.to_host.faults.drop, 0.25);
  EXPECT_EQ(ask("fault corrupt 0.5 to_controller"), "ok");
  EXPECT_EQ(wire_.to_controller.faults.corrupt, 0.5);
  EXPECT_EQ(wire_.to_host.faults.corrupt, 0.0);
  EXPECT_EQ(ask("fault bits 2"), "ok");
  EXPECT_EQ(emulator_.faults(), 2);
  EXPECT_EQ(ask("fault none"), "ok");
  EXPECT_EQ(wire_.to_host.faults.drop, 0.0);
  EXPECT_EQ(emulator_.state(), aesop::RobotState::kFault) << "only the host clears a fault";
  EXPECT_EQ(ask("fault reboot"), "ok");
  EXPECT_EQ(emulator_.state(), aesop::RobotState::kDisabled);
}

TEST_F(EmulatorControlTest, faultsForATimeAndLater) {
  EXPECT_EQ(ask("fault hangup for 2"), "ok");
  EXPECT_EQ(ask("after 3 fault stall to_host for 0.5"), "ok");
  EXPECT_EQ(ask("after 9 fault reboot"), "ok");
  EXPECT_TRUE(wire_.isCut(now_));
  now_ += 2.5;
  ask("state");
  EXPECT_FALSE(wire_.isCut(now_));
  now_ += 0.6;
  ask("state");
  EXPECT_GT(wire_.to_host.faults.stalled_until, now_);
  EXPECT_LT(wire_.to_controller.faults.stalled_until, now_);
  now_ += 0.5;
  ask("state");
  EXPECT_LE(wire_.to_host.faults.stalled_until, now_);
  EXPECT_LT(faults_.next(), 1e6);
  EXPECT_EQ(ask("forget"), "ok");
  EXPECT_GT(faults_.next(), 1e6);
}

TEST_F(EmulatorControlTest, recordOfMotion) {
  EXPECT_EQ(ask("record"), "ok -1 -1 0");
  ask("hand 0.1 0 0 0.01 0.5");
  now_ += 1.0;
  EXPECT_EQ(ask("record"), "ok -1 -1 0") << "a hand is no motor";
}

TEST_F(EmulatorControlTest, nonsenseIsRefused) {
  for (const char* request : {"",
                              " ",
                              "dance",
                              "state 1",
                              "hand",
                              "hand 1 2 3 4",
                              "hand a 0 0 0 1",
                              "hand nan 0 0 0 1",
                              "hand 0 0 0 0 1 2",
                              "fault",
                              "fault drop",
                              "fault drop 2",
                              "fault drop x",
                              "fault drop 0.1 0.2",
                              "fault rust 1",
                              "fault bits 65536",
                              "fault bits -1",
                              "hand 0.1 0 0 0 0.5x",
                              "fault drop 0.1 sideways",
                              "fault drop 0.1 for",
                              "fault drop 0.1 for x",
                              "fault drop 0.1 for 0",
                              "fault reboot for 1",
                              "fault bits 1 to_host",
                              "fault joint 8",
                              "fault joint 1.5",
                              "fault lie white",
                              "fault lie",
                              "after 1",
                              "after 1 state",
                              "after -1 fault none",
                              "after x fault none",
                              "after 1 fault rust",
                              "forget 1",
                              "fault hangup to_host",
                              "fault drop 0.1 to_host for 1 2"}) {
    EXPECT_TRUE(refuses(request)) << "'" << request << "': " << ask(request);
  }
}

}  // namespace
}  // namespace laparoscope_servo::sim
