#include "laparoscope_servo/sim/lies.h"

#include <gtest/gtest.h>

#include <sstream>

namespace laparoscope_servo::sim {
namespace {

using aesop::RobotState;

aesop::Status truth() {
  aesop::Status status;
  status.state = RobotState::kFault;
  status.homed = true;
  status.moving = true;
  status.faults = 5;
  status.echo = 65535;
  status.time = 12.0;
  status.position.setConstant(0.25);
  status.velocity.setConstant(0.125);
  return status;
}

aesop::Status told(Lie lie, const aesop::Status& now) {
  aesop::Status before = truth();
  before.position.setConstant(0.5);
  before.echo = 7;
  Liar liar;
  liar.begin(lie, before);
  return liar.tell(now);
}

// What of it differs from the truth.
std::string differing(const aesop::Status& a, const aesop::Status& b) {
  std::string text;
  if (a.state != b.state) text += "state ";
  if (a.homed != b.homed) text += "homed ";
  if (a.moving != b.moving) text += "moving ";
  if (a.faults != b.faults) text += "faults ";
  if (a.echo != b.echo) text += "echo ";
  if (a.time != b.time) text += "time ";
  if (a.position != b.position) text += "position ";
  if (a.velocity != b.velocity) text += "velocity ";
  return text;
}

TEST(Lies, eachIsOfNothingElse) {
  const auto difference = [](Lie lie) { return differing(told(lie, truth()), truth()); };
  EXPECT_EQ(difference(Lie::kNone), "");
  EXPECT_EQ(difference(Lie::kDisabled), "state ");
  EXPECT_EQ(difference(Lie::kEnabled), "state ");
  EXPECT_EQ(difference(Lie::kHealthy), "state faults ");
  EXPECT_EQ(difference(Lie::kStanding), "moving velocity ");
  EXPECT_EQ(difference(Lie::kMoving), "");
  EXPECT_EQ(difference(Lie::kFrozen), "position ");
  EXPECT_EQ(difference(Lie::kJumped), "position ");
  EXPECT_EQ(difference(Lie::kEchoFrozen), "echo ");
  EXPECT_EQ(difference(Lie::kEchoAhead), "echo ");
}

TEST(Lies, areWhatTheirNamesSay) {
  aesop::Status still = truth();
  still.moving = false;
  EXPECT_TRUE(told(Lie::kMoving, still).moving);
  EXPECT_EQ(told(Lie::kDisabled, truth()).state, RobotState::kDisabled);
  EXPECT_EQ(told(Lie::kEnabled, truth()).state, RobotState::kEnabled);
  EXPECT_EQ(told(Lie::kHealthy, truth()).state, RobotState::kEnabled);
  aesop::Status disabled = truth();
  disabled.state = RobotState::kDisabled;
  EXPECT_EQ(told(Lie::kHealthy, disabled).state, RobotState::kDisabled) << "it hides a fault, and no more";
  EXPECT_EQ(told(Lie::kFrozen, truth()).position[3], 0.5) << "that of the beginning";
  EXPECT_EQ(told(Lie::kEchoFrozen, truth()).echo, 7);
  EXPECT_LT(told(Lie::kEchoAhead, truth()).echo, 2000) << "counts on across the end of 16 bits";
}

TEST(Lies, eachNameLeadsToALieOfItsOwn) {
  std::istringstream names(lieNames());
  int count = 0, last = static_cast<int>(Lie::kNone);
  for (std::string name; names >> name; ++count) {
    const auto lie = lieNamed(name);
    ASSERT_TRUE(lie) << name;
    EXPECT_EQ(static_cast<int>(*lie), ++last) << name;
  }
  EXPECT_EQ(count, static_cast<int>(Lie::kEchoAhead));
  EXPECT_EQ(lieNamed("none"), Lie::kNone);
  EXPECT_FALSE(lieNamed("") || lieNamed("Moving") || lieNamed("moving "));
}

}  // namespace
}  // namespace laparoscope_servo::sim
