// The task STABILISE over topics: it goes by the motion of the view alone, and whatever that lacks is a HOLD.
#include <laparoscope_servo/SelectTask.h>

#include <atomic>

#include "controller_fixture.h"
#include "motion_feed.h"
#include "system/aesop/child_process.h"

namespace laparoscope_servo {
namespace {

using test::ChildProcess;

class ControllerStabilise : public ControllerFixture {
 protected:
  static MotionFeed& motion() {
    static MotionFeed instance;
    return instance;
  }
  static void TearDownTestSuite() {
    motion().end();
    ControllerFixture::TearDownTestSuite();
  }

  void SetUp() override {
    motion_.set([](MotionWords& words) { words = MotionWords{}, words.message = viewOff(40.0, -20.0); });
    ControllerFixture::SetUp();
    // The region of interest is silent: nothing of it is needed.
    cart_.set([](Feed& feed) { feed.task_error = false; });
    SelectTask call;
    call.request.task = SelectTask::Request::STABILISE;
    ASSERT_TRUE(ros::service::call("/controller/select_task", call) && call.response.success) << call.response.message;
    ASSERT_TRUE(waitFor([this] { return cart_.state().task == ControllerState::STABILISE; }));
  }

  void engageAndStabilise() {
    ASSERT_TRUE(cart_.engageWhenReady()) << cart_.answer();
    // The controller may still have the camera_info of the test before, which ends the first engagement.
    ASSERT_TRUE(waitFor([this] {
      if (cart_.state().state == ControllerState::LOST) cart_.engageWhenReady();
      return cart_.state().state == ControllerState::SERVO && cart_.moves();
    })) << cart_.state().reason;
  }
  bool waitForReason(const std::string& reason) {
    return waitFor([&] { return cart_.state().reason.find(reason) != std::string::npos; });
  }

  MotionFeed& motion_ = motion();
};

TEST_F(ControllerStabilise, PansAndTiltsByTheViewAlone) {
  engageAndStabilise();
  // What is seen to the right and above is brought back by a pan to the right and a tilt up.
  for (const ScopeVelocity& command : cart_.nextCommands(50)) {
    EXPECT_GT(command.pan, 0.0);
    EXPECT_GT(command.tilt, 0.0);
    EXPECT_EQ(command.spin, 0.0);
    EXPECT_EQ(command.insertion, 0.0);
  }
}

struct Loss {
  const char* name;
  std::function<void(MotionWords&)> apply;
  const char* reason;
};

TEST_F(ControllerStabilise, EachLossStopsIt) {
  const Loss losses[] = {
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
  };
  for (const Loss& loss : losses) {
    if (cart_.state().state != ControllerState::SERVO) engageAndStabilise();
    motion_.set(loss.apply);
    ASSERT_TRUE(waitForReason(loss.reason)) << loss.name << ": " << cart_.state().reason;
    EXPECT_TRUE(cart_.stands()) << loss.name;
    motion_.set([](MotionWords& w) { w = MotionWords{}, w.message = viewOff(40.0, -20.0); });
    ASSERT_TRUE(waitFor([this] {
      const std::string state = cart_.state().state;
      return state == ControllerState::SERVO || state == ControllerState::LOST;
    })) << loss.name;
  }
}

TEST_F(ControllerStabilise, AnotherCalibrationEndsIt) {
  engageAndStabilise();
  motion_.set([](MotionWords& w) { w.focal_length = 600.0; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << cart_.state().reason;
  EXPECT_TRUE(waitForReason("camera_info has another calibration")) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
}

TEST_F(ControllerStabilise, TimeThatJumpsBackIsAFault) {
  engageAndStabilise();
  motion_.set([](MotionWords& w) { w.stamp_offset = -1.0; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::FAULT)) << cart_.state().reason;
  EXPECT_NE(cart_.state().reason.find("motion of the view jumped back"), std::string::npos) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
}

// Another node wants the opposite: nothing of it counts.
TEST_F(ControllerStabilise, AStrangerMovesNothingAndKeepsNothingMoving) {
  engageAndStabilise();
  ChildProcess stranger("/proc/self/exe", {"publish", "__name:=stranger"});
  std::atomic<bool> heard{false};
  const boost::function<void(const ros::MessageEvent<TrackedFeatures const>&)> hear = [&heard](const auto& event) {
    if (event.getPublisherName() == "/stranger") heard = true;
  };
  ros::Subscriber listener = ros::NodeHandle().subscribe<TrackedFeatures>("/motion_features", 100, hear);
  ASSERT_TRUE(waitFor([&heard] { return heard.load(); }));
  for (const ScopeVelocity& command : cart_.nextCommands(50)) EXPECT_GT(command.pan, 0.0);
  motion_.set([](MotionWords& w) { w.motion = false; });
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
