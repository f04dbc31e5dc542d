// The task POSITION over topics: it goes by the homography of the region; what that lacks is refused by name, or a
// HOLD.
#include "homography_feed.h"
#include "task_fixture.h"

namespace laparoscope_servo {
namespace {

class ControllerPosition : public TaskFixture<HomographyFeed> {
 protected:
  ControllerPosition()
      : TaskFixture("/homography", {SelectTask::Request::POSITION}, [] { return regionOff(0.08, -0.04); }) {}

  void prepareCart() override {
    // Of the task error nothing counts but the region's place.
    cart_.set([](Feed& feed) { feed.message.reference_stamp = ros::Time(3); });
    cart_.nextCommands(10);  // until the controller has it
  }

  static std::vector<Loss> losses() {
    return {
        {"silent", [](PositionWords& w) { w.speaks = false; }, "silent"},
        {"lost", [](PositionWords& w) { w.message.state = Homography::LOST; }, "not valid"},
        {"without intrinsics", [](PositionWords& w) { w.message.has_intrinsics = 0; }, "no intrinsics"},
        {"of another region", [](PositionWords& w) { w.message.reference_stamp = ros::Time(9); },
         "place of the region"},
        {"little is seen", [](PositionWords& w) { w.message.visible_fraction = 0.1; }, "occluded"},
        {"not a number", [](PositionWords& w) { w.message.h[4] = std::nan(""); }, "of no plane"},
        {"stamped ahead", [](PositionWords& w) { w.stamp_offset = 60.0; }, "future"},
        {"without a stamp", [](PositionWords& w) { w.without_stamp = true; }, "no stamp"},
    };
  }
};

// What is seen to the right and above is brought back by a pan to the right and a tilt up, whatever the task error
// says.
TEST_F(ControllerPosition, MovesByTheHomography) {
  cart_.set([](Feed& feed) { feed.message.x = feed.message.desired_x - 0.1; });
  engageAndMove();
  for (const ScopeVelocity& command : cart_.nextCommands(20)) {
    EXPECT_GT(command.pan, 0.0);
    EXPECT_GT(command.tilt, 0.0);
  }
}

TEST_F(ControllerPosition, EachLossStopsIt) {
  eachLossStopsIt(losses());
}

TEST_F(ControllerPosition, EachLossIsRefusedByName) {
  eachLossIsRefusedByName(losses());
}

TEST_F(ControllerPosition, IsLeftAndTakenUpAgain) {
  isLeftAndTakenUpAgain([] {});
}

TEST_F(ControllerPosition, TimeThatJumpsBackIsAFault) {
  engageAndMove();
  timeThatJumpsBackIsAFault("homography of the region jumped back");
}

TEST_F(ControllerPosition, WithoutTheScopesPoseItStands) {
  engageAndMove();
  withoutTheScopesPoseItStands();
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_position");
  return RUN_ALL_TESTS();
}
