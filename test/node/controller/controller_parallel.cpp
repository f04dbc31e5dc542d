// The task PARALLEL over topics: it begins with a circle, and whatever the view or the pose lacks is a HOLD.
#include <cmath>
#include <string>

#include "motion_feed.h"
#include "task_fixture.h"

namespace laparoscope_servo {
namespace {

class ControllerParallel : public TaskFixture<MotionFeed> {
 protected:
  ControllerParallel()
      : TaskFixture("/motion_features", {SelectTask::Request::MANUAL, SelectTask::Request::PARALLEL},
                    [] { return viewOff(0.0, 0.0); }) {}
};

TEST_F(ControllerParallel, GoesRoundByPanAndTiltAlone) {
  engageAgainAndMove();
  double most = 0.0;
  for (const ScopeVelocity& command : cart_.nextCommands(50)) {
    most = std::max(most, std::hypot(command.pan, command.tilt));
    EXPECT_EQ(command.spin, 0.0);
    EXPECT_EQ(command.insertion, 0.0);
  }
  EXPECT_GT(most, 0.05);
}

TEST_F(ControllerParallel, EachLossStopsIt) {
  eachLossHoldsIt({
      {"silent", [](MotionWords& w) { w.motion = false; }, "silent"},
      {"lost", [](MotionWords& w) { w.message.features[0].state = TrackedFeatures::LOST; }, "not valid"},
      {"nothing selected", [](MotionWords& w) { w.message.features.pop_back(); }, "no image was selected"},
      {"uncertain", [](MotionWords& w) { w.message.features[0].expected_error = 5.0; }, "parallel/max_error"},
      {"little follows", [](MotionWords& w) { w.message.features[0].share = 0.1; }, "occluded"},
      {"of another size", [](MotionWords& w) { w.message.features[0].outline[2] = 319.0; }, "another size"},
      {"not a number", [](MotionWords& w) { w.message.features[0].parameters[2] = std::nan(""); }, "not finite"},
      {"stamped ahead", [](MotionWords& w) { w.stamp_offset = 60.0; }, "future"},
      {"without a stamp", [](MotionWords& w) { w.without_stamp = true; }, "no stamp"},
  });
}

TEST_F(ControllerParallel, WithoutPosesItStands) {
  engageAgainAndMove();
  withoutTheScopesPoseItStands();
}

// The fake cart's scope and its view stand, whatever is commanded.
TEST_F(ControllerParallel, WhereNothingMovesTheNormalDoesNotBecomeKnown) {
  engageAgainAndMove();
  ASSERT_TRUE(waitForReason("did not become known")) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
  ASSERT_TRUE(cart_.waitForState(ControllerState::LOST));
  EXPECT_TRUE(cart_.engageWhenReady()) << "the circle can be tried again: " << cart_.answer();
}

TEST_F(ControllerParallel, TimeThatJumpsBackIsAFault) {
  engageAgainAndMove();
  timeThatJumpsBackIsAFault("jumped back");
}

// The last one: the calibration that comes back would end an engagement of the next.
TEST_F(ControllerParallel, AnotherCalibrationEndsIt) {
  engageAgainAndMove();
  anotherCalibrationEndsIt(600.0);
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_parallel");
  return RUN_ALL_TESTS();
}
