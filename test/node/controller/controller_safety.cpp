// The ways between the safety states, where all that can be asked for is asked for.
#include <std_msgs/Empty.h>

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

// A disable, an emergency stop, that is over before the controller's next step.
TEST_F(ControllerSafety, AStopBetweenTwoStepsIsLost) {
  for (const char* stop : {"DISABLED", "FAULT"}) {
    for (int k = 0; k < 4; ++k) {
      engageAndMove();
      std::this_thread::sleep_for(std::chrono::milliseconds(5 * k));
      cart_.once([=](Feed& feed) { feed.robot_state = stop; });
      cart_.once([](Feed&) {});
      ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << cart_.state().reason;
      EXPECT_NE(cart_.state().reason.find(stop), std::string::npos) << cart_.state().reason;
      EXPECT_TRUE(cart_.stands());
    }
  }
}

TEST_F(ControllerSafety, AStopWhoseMessageWasLostIsLost) {
  engageAndMove();
  cart_.set([](Feed& feed) { feed.robot = false; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::HOLD)) << cart_.state().reason;
  cart_.strike([](Feed& feed) { feed.robot = true, ++feed.enables; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
}

TEST_F(ControllerSafety, APauseGoesOnByAResume) {
  engageAndMove();
  cart_.once([](Feed& feed) { feed.robot_state = "PAUSED"; });
  ASSERT_TRUE(waitFor([this] { return cart_.moves() && cart_.state().state == ControllerState::SERVO; }))
      << cart_.state().reason;
  cart_.strike([](Feed& feed) { feed.robot_state = "PAUSED"; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << "paused for longer than resume_time";
  EXPECT_NE(cart_.state().reason.find("paused"), std::string::npos) << cart_.state().reason;
}

// Engaged with the switch held down: nobody has shown yet that it can be let go.
TEST_F(ControllerSafety, ASwitchThatIsHeldHasToBeLetGoOnce) {
  bool success = false;
  ASSERT_TRUE(waitFor([&] {
    cart_.engage(true, success);
    return success;
  })) << cart_.answer();
  ASSERT_TRUE(waitFor([this] { return cart_.state().reason.find("release it once") != std::string::npos; }))
      << cart_.state().reason;
  EXPECT_EQ(cart_.state().state, ControllerState::ARMED);
  EXPECT_TRUE(cart_.stands());
  cart_.letGoOnce();
  EXPECT_TRUE(cart_.waitForState(ControllerState::SERVO));
}

// Whoever may reach the topic may stop the arm; no master is asked.
TEST_F(ControllerSafety, ATopicStops) {
  ros::NodeHandle node;
  ros::Publisher stop = node.advertise<std_msgs::Empty>("/controller/stop", 1);
  ASSERT_TRUE(waitFor([&] { return stop.getNumSubscribers() > 0; }));
  for (const bool holding : {false, true}) {
    engageAndMove();
    if (holding) {
      cart_.strike([](Feed& feed) { feed.message.valid = false; });
      ASSERT_TRUE(cart_.waitForState(ControllerState::HOLD));
    }
    stop.publish(std_msgs::Empty());
    ASSERT_TRUE(cart_.waitForState(ControllerState::IDLE));
    EXPECT_EQ(cart_.state().reason, "stopped by " + ros::this_node::getName());
    cart_.strike([](Feed& feed) { feed.message.valid = true; });
    EXPECT_TRUE(cart_.stands());
  }
  // A fault is for somebody to look at.
  engageAndMove();
  cart_.strike([](Feed& feed) { feed.lateral = 0.03; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::FAULT));
  stop.publish(std_msgs::Empty());
  EXPECT_TRUE(cart_.stands());
  EXPECT_EQ(cart_.state().state, ControllerState::FAULT);
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
