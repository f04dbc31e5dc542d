// The task POINTS over topics: it goes by points of texture alone; what that lacks is refused by name, or a HOLD.
#include "motion_feed.h"
#include "task_fixture.h"

namespace laparoscope_servo {
namespace {

class ControllerPoints : public TaskFixture<MotionFeed> {
 protected:
  ControllerPoints()
      : TaskFixture("/points_features", {SelectTask::Request::POINTS}, [] { return pointsOff(40.0, -20.0); }) {}

  static std::vector<Loss> losses() {
    return {
        {"silent", [](MotionWords& w) { w.motion = false; }, "silent"},
        {"lost",
         [](MotionWords& w) {
           for (TrackedFeature& point : w.message.features) point.state = TrackedFeatures::SEARCHING;
         },
         "not valid"},
        {"none", [](MotionWords& w) { w.message.features.clear(); }, "points/min_points"},
        {"without desired places",
         [](MotionWords& w) {
           for (TrackedFeature& point : w.message.features) point.desired.clear();
         },
         "points/min_points"},
        {"uncertain",
         [](MotionWords& w) {
           for (std::size_t k = 0; k < 12; ++k) w.message.features[k].parameters[k % 2] += k % 3 == 0 ? 24.0 : -12.0;
         },
         "points/max_error"},
        {"of another size", [](MotionWords& w) { w.message.width = 320; }, "another size"},
        {"not a number",
         [](MotionWords& w) {
           for (TrackedFeature& point : w.message.features) point.parameters[1] = std::nan("");
         },
         "not valid"},
        {"stamped ahead", [](MotionWords& w) { w.stamp_offset = 60.0; }, "future"},
        {"without a stamp", [](MotionWords& w) { w.without_stamp = true; }, "no stamp"},
    };
  }
};

// What is seen to the right and above is brought back by a pan to the right and a tilt up.
TEST_F(ControllerPoints, MovesByThePoints) {
  engageAndMove();
  for (const ScopeVelocity& command : cart_.nextCommands(20)) {
    EXPECT_GT(command.pan, 0.0);
    EXPECT_GT(command.tilt, 0.0);
  }
  // Those on an instrument stand still in the image, and have no say.
  feed_.set([](MotionWords& w) {
    for (std::size_t k = 0; k < 3; ++k)
      w.message.features[4 * k + 1].parameters = w.message.features[4 * k + 1].desired;
  });
  for (const ScopeVelocity& command : cart_.nextCommands(20)) EXPECT_GT(command.pan, 0.0);
  EXPECT_EQ(cart_.state().state, ControllerState::SERVO) << cart_.state().reason;
}

TEST_F(ControllerPoints, EachLossStopsIt) {
  eachLossStopsIt(losses());
}

TEST_F(ControllerPoints, EachLossIsRefusedByName) {
  eachLossIsRefusedByName(losses());
}

TEST_F(ControllerPoints, IsLeftAndTakenUpAgain) {
  isLeftAndTakenUpAgain([this] {
    EXPECT_TRUE(waitForReason("task error")) << cart_.state().reason;
    EXPECT_TRUE(cart_.stands());
  });
}

TEST_F(ControllerPoints, AnotherCalibrationEndsIt) {
  // There and back, so that the next test has the first one.
  for (const double focal_length : {600.0, 500.0}) {
    engageAndMove();
    anotherCalibrationEndsIt(focal_length);
  }
}

TEST_F(ControllerPoints, TimeThatJumpsBackIsAFault) {
  engageAndMove();
  timeThatJumpsBackIsAFault("points of the view jumped back");
}

TEST_F(ControllerPoints, WithoutTheScopesPoseItStands) {
  engageAndMove();
  withoutTheScopesPoseItStands();
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_points");
  return RUN_ALL_TESTS();
}
