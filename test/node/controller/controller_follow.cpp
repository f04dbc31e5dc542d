// The task FOLLOW over topics: it goes by the middle of a moving object alone; what that lacks is refused by name, or a
// HOLD.
#include "motion_feed.h"
#include "task_fixture.h"

namespace laparoscope_servo {
namespace {

class ControllerFollow : public TaskFixture<MotionFeed> {
 protected:
  ControllerFollow()
      : TaskFixture("/motion_features", {SelectTask::Request::FOLLOW},
                    [] { return objectAt(380.0, 200.0, ++selected()); }) {}

  // s: each selection has a stamp of its own.
  static double& selected() {
    static double last = 3.0;
    return last;
  }

  static std::vector<Loss> losses() {
    return {
        {"silent", [](MotionWords& w) { w.motion = false; }, "silent"},
        {"lost", [](MotionWords& w) { w.message.features[0].state = TrackedFeatures::SEARCHING; },
         "the object was lost"},
        {"nothing selected", [](MotionWords& w) { w.message.features.clear(); }, "no object was selected"},
        {"the whole view", [](MotionWords& w) { w.message = viewOff(40.0, -20.0); }, "no object was selected"},
        {"uncertain", [](MotionWords& w) { w.message.features[0].expected_error = 9.0; }, "follow/max_error"},
        {"little follows", [](MotionWords& w) { w.message.features[0].share = 0.1; }, "occluded"},
        {"of another size", [](MotionWords& w) { w.message.width = 320; }, "another size"},
        {"leaves", [](MotionWords& w) { w.message.features[0].outline.assign(10, 700.0); }, "the object leaves"},
        {"not a number", [](MotionWords& w) { w.message.features[0].outline[2] = std::nan(""); }, "not finite"},
        {"stamped ahead", [](MotionWords& w) { w.stamp_offset = 60.0; }, "future"},
        {"without a stamp", [](MotionWords& w) { w.without_stamp = true; }, "no stamp"},
    };
  }
};

TEST_F(ControllerFollow, PansAndTiltsByTheObjectAlone) {
  engageAndMove();
  // What is seen to the right and above is brought back by a pan to the right and a tilt up.
  for (const ScopeVelocity& command : cart_.nextCommands(50)) {
    EXPECT_GT(command.pan, 0.0);
    EXPECT_GT(command.tilt, 0.0);
    EXPECT_EQ(command.spin, 0.0);
    EXPECT_EQ(command.insertion, 0.0);
  }
}

// Its region may lie on what is behind it by then.
TEST_F(ControllerFollow, AnObjectThatWasLostIsNotFollowedUntilItIsSelectedAnew) {
  engageAndMove();
  feed_.set([](MotionWords& w) { w.message.features[0].state = TrackedFeatures::SEARCHING; });
  ASSERT_TRUE(waitForReason("the object was lost")) << cart_.state().reason;
  feed_.set([](MotionWords& w) { w.message.features[0].state = TrackedFeatures::TRACKING; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << cart_.state().reason;
  EXPECT_TRUE(waitForRefusal("the object was lost")) << cart_.answer();
  show();
  engageAndMove();
}

TEST_F(ControllerFollow, EachLossStopsIt) {
  eachLossStopsIt(losses());
}

TEST_F(ControllerFollow, EachLossIsRefusedByName) {
  eachLossIsRefusedByName(losses());
}

TEST_F(ControllerFollow, IsLeftAndTakenUpAgain) {
  isLeftAndTakenUpAgain([this] {
    EXPECT_TRUE(waitForReason("task error")) << cart_.state().reason;
    EXPECT_TRUE(cart_.stands());
  });
}

TEST_F(ControllerFollow, AnotherCalibrationEndsIt) {
  // There and back, so that the next test has the first one.
  for (const double focal_length : {600.0, 500.0}) {
    engageAndMove();
    anotherCalibrationEndsIt(focal_length);
  }
}

TEST_F(ControllerFollow, TimeThatJumpsBackIsAFault) {
  engageAndMove();
  timeThatJumpsBackIsAFault("motion of the object jumped back");
}

TEST_F(ControllerFollow, WithoutTheScopesPoseItStands) {
  engageAndMove();
  withoutTheScopesPoseItStands();
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_follow");
  return RUN_ALL_TESTS();
}
