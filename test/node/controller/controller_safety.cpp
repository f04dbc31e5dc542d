// The ways between the safety states, where all that can be asked for is asked for.
#include "controller_fixture.h"

namespace laparoscope_servo {
namespace {

class ControllerSafety : public ControllerFixture {
 protected:
  // Of the last command.
  double pan() { return cart_.nextCommands(1).back().pan; }
};

TEST_F(ControllerSafety, TheDeadManSwitchLetsMoveAndStops) {
  cart_.strike([](Feed& feed) { feed.pressed = false; });
  ASSERT_TRUE(cart_.engageWhenReady());  // it refuses nothing
  ASSERT_TRUE(cart_.waitForState(ControllerState::ARMED));
  EXPECT_TRUE(cart_.state().engaged);
  EXPECT_NE(cart_.state().reason.find("dead-man"), std::string::npos) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
  cart_.strike([](Feed& feed) { feed.pressed = true; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO));
  ASSERT_TRUE(waitFor([this] { return cart_.moves(); }));
  cart_.strike([](Feed& feed) { feed.pressed = false; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::ARMED));
  EXPECT_TRUE(cart_.stands());
  // What is missing beside it is the more severe.
  cart_.strike([](Feed& feed) { feed.message.valid = false; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::HOLD));
  cart_.strike([](Feed& feed) { feed.message.valid = true; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::ARMED));
  EXPECT_TRUE(cart_.stands());
}

TEST_F(ControllerSafety, ARobotThatStaysDisabledIsLost) {
  engageAndMove();
  cart_.strike([](Feed& feed) { feed.robot_state = "DISABLED"; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::LOST));
  EXPECT_NE(cart_.state().reason.find("not enabled"), std::string::npos) << cart_.state().reason;
  EXPECT_FALSE(cart_.state().engaged);
  // Somebody who enables the arm does not set it in motion by that.
  cart_.strike([](Feed& feed) { feed.robot_state = "ENABLED"; });
  EXPECT_TRUE(cart_.stands());
  EXPECT_EQ(cart_.state().state, ControllerState::LOST);
  engageAndMove();
}

TEST_F(ControllerSafety, DoesNotEngageADisabledRobot) {
  cart_.strike([](Feed& feed) { feed.robot_state = "DISABLED"; });
  bool success = true;
  std::string message;
  EXPECT_TRUE(waitFor([&] {
    message = cart_.engage(true, success);
    if (success) cart_.engage(false, success);
    return message.find("not enabled") != std::string::npos;
  })) << message;
  EXPECT_TRUE(cart_.stands());
}

TEST_F(ControllerSafety, OcclusionSlowsThenHoldsAndResumesLater) {
  cart_.strike([](Feed& feed) { feed.message.x = feed.message.e_v.x = 1.0; });  // as fast as it may
  engageAndMove();
  EXPECT_TRUE(waitFor([this] { return pan() > 0.0999; }));
  cart_.strike([](Feed& feed) { feed.message.visible_fraction = 0.35; });
  // Half of what the dead zone leaves of 0.1 rad/s, and the dead zone.
  EXPECT_TRUE(waitFor([this] { return pan() < 0.0521; }));
  EXPECT_GT(pan(), 0.0);
  EXPECT_EQ(cart_.state().state, ControllerState::SERVO);
  cart_.strike([](Feed& feed) { feed.message.visible_fraction = 0.19; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::HOLD));
  EXPECT_TRUE(cart_.stands());
  cart_.strike([](Feed& feed) { feed.message.visible_fraction = 0.24; });
  EXPECT_TRUE(cart_.stands());
  EXPECT_EQ(cart_.state().state, ControllerState::HOLD);
  cart_.strike([](Feed& feed) { feed.message.visible_fraction = 0.26; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO));
  EXPECT_TRUE(waitFor([this] { return cart_.moves(); }));
}

TEST_F(ControllerSafety, GoesNoDeeperOnPoorConfidence) {
  engageAndMove();
  ASSERT_TRUE(waitFor([this] { return cart_.nextCommands(1).back().insertion > 0.0; }));
  cart_.strike([](Feed& feed) { feed.message.corner_error = 1.5; });
  ASSERT_TRUE(waitFor([this] { return cart_.nextCommands(1).back().insertion == 0.0; }));
  for (const ScopeVelocity& command : cart_.nextCommands(10)) {
    EXPECT_EQ(command.insertion, 0.0);
    EXPECT_NE(command.pan, 0.0);
  }
  EXPECT_EQ(cart_.state().state, ControllerState::SERVO);
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_safety");
  return RUN_ALL_TESTS();
}
