// The controller among tracker and robot: it moves when engaged and everything is there, and stands still otherwise.
#include <diagnostic_msgs/DiagnosticArray.h>

#include <limits>

#include "controller_fixture.h"

namespace laparoscope_servo {
namespace {

class ControllerEngage : public ControllerFixture {
 protected:
  // After this change of what is published, the arm stands and the reason holds these words.
  void expectHold(const std::function<void(Feed&)>& change, const std::string& words) {
    engageAndMove();
    cart_.set(change);
    ASSERT_TRUE(cart_.waitForState(ControllerState::HOLD)) << words << ": " << cart_.state().reason;
    EXPECT_NE(cart_.state().reason.find(words), std::string::npos) << cart_.state().reason;
    EXPECT_TRUE(cart_.state().engaged);
    EXPECT_TRUE(cart_.stands()) << words;
  }

  // After a fault only disengaging leads on.
  void expectFault(const std::string& words) {
    ASSERT_TRUE(cart_.waitForState(ControllerState::FAULT)) << words << ": " << cart_.state().reason;
    EXPECT_NE(cart_.state().reason.find(words), std::string::npos) << cart_.state().reason;
    EXPECT_FALSE(cart_.state().engaged);
    EXPECT_TRUE(cart_.stands());
    bool success = true;
    EXPECT_NE(cart_.engage(true, success).find("disengage"), std::string::npos);
    EXPECT_FALSE(success);
    EXPECT_EQ(cart_.state().state, ControllerState::FAULT);
  }

  void expectRefused(const std::function<void(Feed&)>& change, const std::string& words) {
    cart_.set(change);
    bool success = true;
    std::string message;
    EXPECT_TRUE(waitFor([&] {
      message = cart_.engage(true, success);
      if (success) cart_.engage(false, success = false);  // the change has not come through yet
      return message.find(words) != std::string::npos;
    })) << message;
    EXPECT_FALSE(success);
    EXPECT_TRUE(cart_.stands());
    EXPECT_EQ(cart_.state().state, ControllerState::IDLE);
  }
};

TEST_F(ControllerEngage, PublishesZerosWhileNotEngaged) {
  EXPECT_TRUE(waitFor([this] { return cart_.state().reason == "not engaged"; })) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
  EXPECT_EQ(cart_.state().state, ControllerState::IDLE);
  EXPECT_FALSE(cart_.state().engaged);
}

TEST_F(ControllerEngage, FollowsOnceEngagedAndStopsWhenDisengaged) {
  engageAndMove();
  const ScopeVelocity command = cart_.nextCommands(20).back();
  EXPECT_GT(command.pan, 0.0);
  EXPECT_GT(command.tilt, 0.0);
  EXPECT_LT(command.spin, 0.0);
  EXPECT_GT(command.insertion, 0.0);
  EXPECT_EQ(command.header.frame_id, "scope_tip");
  EXPECT_FALSE(command.header.stamp.isZero());
  EXPECT_EQ(cart_.state().reason, "engaged, nothing is missing");
  bool success = false;
  cart_.engage(false, success);
  EXPECT_TRUE(success);
  EXPECT_TRUE(waitFor([this] { return cart_.stands(); }));
  EXPECT_TRUE(cart_.waitForState(ControllerState::IDLE));
}

TEST_F(ControllerEngage, KeepsItsLimits) {
  TaskError far = offTarget();
  far.x = 1.0;
  engageAndMove(far);
  EXPECT_TRUE(waitFor([this] { return cart_.nextCommands(1).back().pan > 0.0999; }));
  for (const ScopeVelocity& command : cart_.nextCommands(30)) {
    EXPECT_LE(std::abs(command.pan), 0.1 * (1.0 + 1e-9));
    EXPECT_LE(std::abs(command.insertion), 0.02 * (1.0 + 1e-9));
  }
}

TEST_F(ControllerEngage, RefusesWhatIsNotValid) {
  expectRefused([](Feed& feed) { feed.message.valid = false; }, "not valid");
}

TEST_F(ControllerEngage, RefusesWithoutTaskErrors) {
  expectRefused([](Feed& feed) { feed.task_error = false; }, "task error");
}

TEST_F(ControllerEngage, RefusesWithoutTf) {
  expectRefused([](Feed& feed) { feed.tf = false; }, "depth d2");
}

TEST_F(ControllerEngage, HoldsWhenTheTrackerLosesAndResumes) {
  expectHold([](Feed& feed) { feed.message.valid = false; }, "not valid");
  cart_.set([](Feed& feed) { feed.message.valid = true; });
  EXPECT_TRUE(cart_.waitForState(ControllerState::SERVO));
  EXPECT_TRUE(waitFor([this] { return cart_.moves(); }));
}

// A region that somebody selects while the scope is held is not followed by itself.
TEST_F(ControllerEngage, AnotherRegionWhileTheArmIsWaitedForIsLost) {
  engageAndMove();
  cart_.set([](Feed& feed) { feed.tf = false; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::HOLD));
  cart_.set([](Feed& feed) { feed.message.reference_stamp = ros::Time(1.0); });
  ASSERT_TRUE(cart_.waitForState(ControllerState::LOST));
  EXPECT_NE(cart_.state().reason.find("another region"), std::string::npos) << cart_.state().reason;
  cart_.set([](Feed& feed) { feed.tf = true; });
  EXPECT_FALSE(cart_.waitForState(ControllerState::SERVO, 0.5));
  EXPECT_TRUE(cart_.stands());
}

// A picture that is only turned: a straight scope spins, an oblique one has to turn its tip, too.
TEST_F(ControllerEngage, ObliqueOpticsServoInTheShaftsAxes) {
  TaskError turned = offTarget();
  turned.x = turned.y = turned.log_depth = 0.0;
  turned.e_v.x = turned.e_v.y = turned.e_v.z = 0.0;
  turned.alpha = 0.5;
  for (const double optics : {0.0, 0.5236}) {
    bool success = false;
    cart_.engage(false, success);  // nobody turns the optics while the scope is driven: that is a fault
    ASSERT_TRUE(success);
    cart_.strike([=](Feed& feed) { feed.optics = optics; });
    cart_.nextCommands(10);  // until the controller has it
    engageAndMove(turned);
    const auto settled = [&] {
      const ScopeVelocity command = cart_.nextCommands(1).back();
      return command.spin > 0.05 && (std::abs(command.pan) > 0.02) == (optics > 0.0);
    };
    EXPECT_TRUE(waitFor(settled)) << optics << ": pan " << cart_.nextCommands(1).back().pan;
  }
}

TEST_F(ControllerEngage, IsLostWhenTheTaskErrorStaysAway) {
  expectHold([](Feed& feed) { feed.task_error = false; }, "older than");
  EXPECT_TRUE(cart_.waitForState(ControllerState::LOST));
  EXPECT_FALSE(cart_.state().engaged);
  EXPECT_NE(cart_.state().reason.find("engage again"), std::string::npos) << cart_.state().reason;
  cart_.set([](Feed& feed) { feed.task_error = true; });
  EXPECT_TRUE(cart_.stands());
  engageAndMove();
}

TEST_F(ControllerEngage, HoldsOnNumbersThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  expectHold([=](Feed& feed) { feed.message.e_v.x = nan; }, "not finite");
  expectHold([=](Feed& feed) { feed.message.e_w.z = infinity; }, "not finite");
  expectHold([=](Feed& feed) { feed.message.m_star.y = nan; }, "not finite");
  expectHold([=](Feed& feed) { feed.message.desired_alpha = nan; }, "not finite");
}

TEST_F(ControllerEngage, HoldsWhenTfStops) {
  expectHold([](Feed& feed) { feed.tf = false; }, "depth d2 is older");
}

TEST_F(ControllerEngage, HoldsOnDepthThatCannotBe) {
  expectHold([](Feed& feed) { feed.d2 = 0.6; }, "depth d2 is not between");
}

TEST_F(ControllerEngage, HoldsOnADepthBehindTheInsertionPoint) {
  expectHold([](Feed& feed) { feed.d2 = -0.1; }, "depth d2 is not between");
}

TEST_F(ControllerEngage, AShaftThatMissesTheInsertionPointIsAFault) {
  engageAndMove();
  cart_.set([](Feed& feed) { feed.lateral = 0.03; });
  expectFault("insertion point");
}

TEST_F(ControllerEngage, HoldsWhenTheSameImageIsSentAgainAndAgain) {
  // Ahead by less than the tolerance, so that it does not look old on ROS time for the while that the test takes.
  expectHold([](Feed& feed) { feed.fixed_stamp = ros::Time::now() + ros::Duration(0.08); }, "older than");
}

TEST_F(ControllerEngage, StampsThatJumpBackAreAFault) {
  engageAndMove();
  cart_.set([](Feed& feed) { feed.stamp_offset = -1.0; });
  expectFault("jumped back");
  bool success = false;
  cart_.engage(false, success);
  // The images stay too old to engage again.
  expectRefused([](Feed&) {}, "image behind the task error is older than");
}

TEST_F(ControllerEngage, HoldsOnStampsInTheFuture) {
  expectHold([](Feed& feed) { feed.stamp_offset = 2.0; }, "future");
}

TEST_F(ControllerEngage, HoldsOnARobotInTheFuture) {
  expectHold([](Feed& feed) { feed.robot_stamp_offset = 0.5; }, "operating state is stamped in the future");
}

// A camera driver that mixes up its buffers now and then.
TEST_F(ControllerEngage, SingleStampsThatAreOffChangeNothing) {
  engageAndMove();
  std::vector<std::function<void(Feed&)>> slips{[](Feed& feed) { feed.without_stamp = true; }};
  for (const double offset : {-5.0, -0.05, 0.5, 1e6}) slips.push_back([=](Feed& feed) { feed.stamp_offset = offset; });
  for (const auto& slip : slips) {
    cart_.once(slip);
    for (const ScopeVelocity& command : cart_.nextCommands(15)) EXPECT_FALSE(isZero(command));
    EXPECT_EQ(cart_.state().state, ControllerState::SERVO) << cart_.state().reason;
  }
}

TEST_F(ControllerEngage, HoldsOnTaskErrorsWithoutAStamp) {
  expectHold([](Feed& feed) { feed.without_stamp = true; }, "has no stamp");
}

TEST_F(ControllerEngage, HoldsOnTfInTheFuture) {
  expectHold([](Feed& feed) { feed.tf_stamp_offset = 2.0; }, "future");
}

TEST_F(ControllerEngage, ReportsDiagnostics) {
  ros::NodeHandle node;
  std::mutex mutex;
  std::vector<diagnostic_msgs::DiagnosticStatus> found;
  const ros::Subscriber subscriber = node.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10, [&](const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
        const std::lock_guard<std::mutex> lock(mutex);
        for (const auto& status : message->status) found.push_back(status);
      });
  expectHold([](Feed& feed) { feed.message.valid = false; }, "not valid");
  EXPECT_TRUE(waitFor([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    for (const auto& status : found) {
      if (status.name == "controller: control" && status.message.find("not valid") != std::string::npos) return true;
    }
    return false;
  }));
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_engage");
  return RUN_ALL_TESTS();
}
