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

// Task errors that are not valid: older than each homography they say nothing of it, as new or newer they do.
TEST_F(ControllerPosition, AnOlderTaskErrorDoesNotDenyTheHomographyAndANewerOneDoes) {
  cart_.set([](Feed& feed) {
    feed.stamp_offset = -0.09;  // s: more than two periods of the homography, and no jump of the clock
    feed.message.valid = false;
  });
  cart_.nextCommands(20);
  engageAndMove();
  int still = 0;
  for (const ScopeVelocity& command : cart_.nextCommands(100)) still += isZero(command) ? 1 : 0;
  EXPECT_LT(still, 10) << "of 100, where a busy machine makes a homography late";
  feed_.set([](PositionWords& w) { w.stamp_offset = -0.08; });
  cart_.set([](Feed& feed) { feed.stamp_offset = 0.0; });
  ASSERT_TRUE(waitForReason("not valid")) << cart_.state().reason;
  for (const ScopeVelocity& command : cart_.nextCommands(20)) EXPECT_TRUE(isZero(command));
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
