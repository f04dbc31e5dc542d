// The task CENTRE_TIP over topics: it goes by the tip of one instrument alone, and whatever that lacks is a HOLD.
#include "motion_feed.h"
#include "task_fixture.h"

namespace laparoscope_servo {
namespace {

class ControllerCentreTip : public TaskFixture<MotionFeed> {
 protected:
  // The tip is outside of the zone, to the right.
  ControllerCentreTip()
      : TaskFixture("/instrument_features", {SelectTask::Request::CENTRE_TIP}, [] { return tipAt(440.0, 240.0); }) {}
};

TEST_F(ControllerCentreTip, PansToATipOutsideItsZoneAndRestsWithinIt) {
  engageAndMove();
  for (const ScopeVelocity& command : cart_.nextCommands(20)) {
    EXPECT_GT(command.pan, 0.0);
    EXPECT_EQ(command.spin, 0.0);
    EXPECT_EQ(command.insertion, 0.0);
  }
  show(tipAt(330.0, 240.0));
  ASSERT_TRUE(waitFor([this] { return cart_.stands(); }));
  for (const ScopeVelocity& command : cart_.nextCommands(50)) EXPECT_TRUE(isZero(command));
  EXPECT_EQ(cart_.state().state, ControllerState::SERVO) << cart_.state().reason;
}

// The other one is nearer, but somebody engaged with this one.
TEST_F(ControllerCentreTip, AnotherInstrumentDoesNotTakeItsPlace) {
  engageAndMove();
  show(tipAt(200.0, 240.0, "2"));
  ASSERT_TRUE(waitForReason("not valid")) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
  ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << cart_.state().reason;
}

TEST_F(ControllerCentreTip, EachLossStopsIt) {
  eachLossStopsIt({
      {"silent", [](MotionWords& w) { w.motion = false; }, "silent"},
      {"lost", [](MotionWords& w) { w.message.features[0].state = TrackedFeatures::LOST; }, "not valid"},
      {"no instrument", [](MotionWords& w) { w.message.features.clear(); }, "not valid"},
      {"leaves", [](MotionWords& w) { w.message.features[0].parameters[0] = 600.0; }, "the tip leaves"},
      {"uncertain", [](MotionWords& w) { w.message.features[0].expected_error = 9.0; }, "centre_tip/max_error"},
      {"not a number", [](MotionWords& w) { w.message.features[0].parameters[1] = std::nan(""); }, "not finite"},
      {"of another size", [](MotionWords& w) { w.message.width = 320; }, "another size"},
      {"stamped ahead", [](MotionWords& w) { w.stamp_offset = 60.0; }, "future"},
      {"without a stamp", [](MotionWords& w) { w.without_stamp = true; }, "no stamp"},
  });
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_centre_tip");
  return RUN_ALL_TESTS();
}
