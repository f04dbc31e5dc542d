// The task STABILISE over topics: it goes by the motion of the view alone, and whatever that lacks is a HOLD.
#include <atomic>

#include "motion_feed.h"
#include "system/aesop/child_process.h"
#include "task_fixture.h"

namespace laparoscope_servo {
namespace {

using test::ChildProcess;

class ControllerStabilise : public TaskFixture<MotionFeed> {
 protected:
  ControllerStabilise()
      : TaskFixture("/motion_features", {SelectTask::Request::STABILISE}, [] { return viewOff(40.0, -20.0); }) {}
};

TEST_F(ControllerStabilise, PansAndTiltsByTheViewAlone) {
  engageAgainAndMove();
  // What is seen to the right and above is brought back by a pan to the right and a tilt up.
  for (const ScopeVelocity& command : cart_.nextCommands(50)) {
    EXPECT_GT(command.pan, 0.0);
    EXPECT_GT(command.tilt, 0.0);
    EXPECT_EQ(command.spin, 0.0);
    EXPECT_EQ(command.insertion, 0.0);
  }
}

TEST_F(ControllerStabilise, EachLossStopsIt) {
  eachLossHoldsIt({
      {"silent", [](MotionWords& w) { w.motion = false; }, "silent"},
      {"lost", [](MotionWords& w) { w.message.features[0].state = TrackedFeatures::LOST; }, "not valid"},
      {"nothing selected", [](MotionWords& w) { w.message.features.pop_back(); }, "no image was selected"},
      {"no feature", [](MotionWords& w) { w.message.features.clear(); }, "not valid"},
      {"uncertain", [](MotionWords& w) { w.message.features[0].expected_error = 5.0; }, "stabilise/max_error"},
      {"little follows", [](MotionWords& w) { w.message.features[0].share = 0.1; }, "occluded"},
      {"of another size", [](MotionWords& w) { w.message.features[0].outline[2] = 319.0; }, "another size"},
      {"not a number", [](MotionWords& w) { w.message.features[0].parameters[2] = std::nan(""); }, "not finite"},
      {"stamped ahead", [](MotionWords& w) { w.stamp_offset = 60.0; }, "future"},
      {"without a stamp", [](MotionWords& w) { w.without_stamp = true; }, "no stamp"},
  });
}

TEST_F(ControllerStabilise, AnotherCalibrationEndsIt) {
  engageAgainAndMove();
  anotherCalibrationEndsIt(600.0);
}

TEST_F(ControllerStabilise, TimeThatJumpsBackIsAFault) {
  engageAgainAndMove();
  timeThatJumpsBackIsAFault("motion of the view jumped back");
}

// Another node wants the opposite: nothing of it counts.
TEST_F(ControllerStabilise, AStrangerMovesNothingAndKeepsNothingMoving) {
  engageAgainAndMove();
  ChildProcess stranger("/proc/self/exe", {"publish", "__name:=stranger"});
  std::atomic<bool> heard{false};
  const boost::function<void(const ros::MessageEvent<TrackedFeatures const>&)> hear = [&heard](const auto& event) {
    if (event.getPublisherName() == "/stranger") heard = true;
  };
  ros::Subscriber listener = ros::NodeHandle().subscribe<TrackedFeatures>("/motion_features", 100, hear);
  ASSERT_TRUE(waitFor([&heard] { return heard.load(); }));
  for (const ScopeVelocity& command : cart_.nextCommands(50)) EXPECT_GT(command.pan, 0.0);
  feed_.set([](MotionWords& w) { w.motion = false; });
  ASSERT_TRUE(waitForReason("silent")) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands()) << "the stranger still speaks";
}

int publish() {
  MotionFeed feed;
  feed.set([](MotionWords& words) { words.message = viewOff(-40.0, 20.0); });
  ros::spin();
  return 0;
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_stabilise");
  if (argc > 1 && std::string(argv[1]) == "publish") return laparoscope_servo::publish();
  return RUN_ALL_TESTS();
}
