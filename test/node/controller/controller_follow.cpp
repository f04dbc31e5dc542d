// The task FOLLOW over topics: it goes by the middle of a moving object alone; what that lacks is refused by name, or a
// HOLD.
#include <laparoscope_servo/SelectTask.h>

#include "controller_fixture.h"
#include "motion_feed.h"

namespace laparoscope_servo {
namespace {

class ControllerFollow : public ControllerFixture {
 protected:
  static MotionFeed& feed() {
    static MotionFeed instance("/motion_features");
    return instance;
  }
  static double& selections() {
    static double last = 3.0;
    return last;
  }
  static void TearDownTestSuite() {
    feed().end();
    ControllerFixture::TearDownTestSuite();
  }

  void SetUp() override {
    show(objectAt(380.0, 200.0, ++selected_));
    ControllerFixture::SetUp();
    // The region of interest is silent: nothing of it is needed.
    cart_.set([](Feed& feed) { feed.task_error = false; });
    select(SelectTask::Request::FOLLOW);
  }
  void select(const std::string& task) {
    SelectTask call;
    call.request.task = task;
    ASSERT_TRUE(ros::service::call("/controller/select_task", call) && call.response.success) << call.response.message;
    ASSERT_TRUE(waitFor([&] { return cart_.state().task == task; }));
  }
  void show(const TrackedFeatures& features) {
    feed_.set([&](MotionWords& words) { words = MotionWords{}, words.message = features; });
  }
  void engageAndMove() {
    ASSERT_TRUE(cart_.engageWhenReady()) << cart_.answer();
    ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO)) << cart_.state().reason;
    ASSERT_TRUE(waitFor([this] { return cart_.moves(); }));
  }
  bool waitForReason(const std::string& reason) {
    return waitFor([&] { return cart_.state().reason.find(reason) != std::string::npos; });
  }
  // What is said when somebody wants to engage now.
  bool waitForRefusal(const std::string& reason) {
    return waitFor([&] {
      bool success = true;
      const std::string answer = cart_.engage(true, success);
      if (success) cart_.engage(false, success);
      return answer.find("not engaged") != std::string::npos && answer.find(reason) != std::string::npos;
    });
  }

  MotionFeed& feed_ = feed();
  double& selected_ = selections();  // s, each selection has a stamp of its own
};

struct Loss {
  const char* name;
  std::function<void(MotionWords&)> apply;
  const char* reason;
};

const Loss kLosses[] = {
    {"silent", [](MotionWords& w) { w.motion = false; }, "silent"},
    {"lost", [](MotionWords& w) { w.message.features[0].state = TrackedFeatures::SEARCHING; }, "the object was lost"},
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
  show(objectAt(380.0, 200.0, ++selected_));
  engageAndMove();
}

TEST_F(ControllerFollow, EachLossStopsIt) {
  for (const Loss& loss : kLosses) {
    engageAndMove();
    feed_.set(loss.apply);
    ASSERT_TRUE(waitForReason(loss.reason)) << loss.name << ": " << cart_.state().reason;
    EXPECT_TRUE(cart_.stands()) << loss.name;
    ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << loss.name << ": " << cart_.state().reason;
    show(objectAt(380.0, 200.0, ++selected_));
  }
}

TEST_F(ControllerFollow, EachLossIsRefusedByName) {
  for (const Loss& loss : kLosses) {
    bool success = false;
    ASSERT_TRUE(cart_.engageWhenReady()) << cart_.answer();  // nothing is missing yet
    cart_.engage(false, success);
    feed_.set(loss.apply);
    EXPECT_TRUE(waitForRefusal(loss.reason)) << loss.name << ": " << cart_.answer();
    show(objectAt(380.0, 200.0, ++selected_));
  }
}

TEST_F(ControllerFollow, IsLeftAndTakenUpAgain) {
  engageAndMove();
  select(SelectTask::Request::HOLD_VIEW);
  EXPECT_TRUE(waitForReason("task error")) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
  select(SelectTask::Request::FOLLOW);
  bool success = false;
  cart_.engage(false, success);
  ASSERT_TRUE(cart_.waitForState(ControllerState::IDLE));
  engageAndMove();
}

TEST_F(ControllerFollow, AnotherCalibrationEndsIt) {
  // There and back, so that the next test has the first one.
  for (const double focal_length : {600.0, 500.0}) {
    engageAndMove();
    feed_.set([=](MotionWords& w) { w.focal_length = focal_length; });
    ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << cart_.state().reason;
    EXPECT_TRUE(waitForReason("camera_info has another calibration")) << cart_.state().reason;
    EXPECT_TRUE(cart_.stands());
  }
}

TEST_F(ControllerFollow, TimeThatJumpsBackIsAFault) {
  engageAndMove();
  feed_.set([](MotionWords& w) { w.stamp_offset = -1.0; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::FAULT)) << cart_.state().reason;
  EXPECT_NE(cart_.state().reason.find("motion of the object jumped back"), std::string::npos) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
}

TEST_F(ControllerFollow, WithoutTheScopesPoseItStands) {
  engageAndMove();
  cart_.set([](Feed& feed) { feed.tf = false; });
  ASSERT_TRUE(waitFor([this] { return cart_.state().state == ControllerState::HOLD; })) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_follow");
  return RUN_ALL_TESTS();
}
