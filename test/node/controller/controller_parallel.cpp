// The task PARALLEL over topics: it begins with a circle, and whatever the view or the pose lacks is a HOLD.
#include <laparoscope_servo/SelectTask.h>

#include <cmath>
#include <string>

#include "controller_fixture.h"
#include "motion_feed.h"

namespace laparoscope_servo {
namespace {

class ControllerParallel : public ControllerFixture {
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
    motion_.set([](MotionWords& words) { words = MotionWords{}, words.message = viewOff(0.0, 0.0); });
    ControllerFixture::SetUp();
    cart_.set([](Feed& feed) { feed.task_error = false; });
    for (const std::string& name : {SelectTask::Request::MANUAL, SelectTask::Request::PARALLEL}) {
      SelectTask call;
      call.request.task = name;
      ASSERT_TRUE(ros::service::call("/controller/select_task", call) && call.response.success)
          << call.response.message;
      ASSERT_TRUE(waitFor([&] { return cart_.state().task == name; }));
    }
  }

  void engageAndGoRound() {
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

TEST_F(ControllerParallel, GoesRoundByPanAndTiltAlone) {
  engageAndGoRound();
  double most = 0.0;
  for (const ScopeVelocity& command : cart_.nextCommands(50)) {
    most = std::max(most, std::hypot(command.pan, command.tilt));
    EXPECT_EQ(command.spin, 0.0);
    EXPECT_EQ(command.insertion, 0.0);
  }
  EXPECT_GT(most, 0.05);
}

struct Loss {
  const char* name;
  std::function<void(MotionWords&)> apply;
  const char* reason;
};

TEST_F(ControllerParallel, EachLossStopsIt) {
  const Loss losses[] = {
      {"silent", [](MotionWords& w) { w.motion = false; }, "silent"},
      {"lost", [](MotionWords& w) { w.message.features[0].state = TrackedFeatures::LOST; }, "not valid"},
      {"nothing selected", [](MotionWords& w) { w.message.features.pop_back(); }, "no image was selected"},
      {"uncertain", [](MotionWords& w) { w.message.features[0].expected_error = 5.0; }, "parallel/max_error"},
      {"little follows", [](MotionWords& w) { w.message.features[0].share = 0.1; }, "occluded"},
      {"of another size", [](MotionWords& w) { w.message.features[0].outline[2] = 319.0; }, "another size"},
      {"not a number", [](MotionWords& w) { w.message.features[0].parameters[2] = std::nan(""); }, "not finite"},
      {"stamped ahead", [](MotionWords& w) { w.stamp_offset = 60.0; }, "future"},
      {"without a stamp", [](MotionWords& w) { w.without_stamp = true; }, "no stamp"},
  };
  for (const Loss& loss : losses) {
    if (cart_.state().state != ControllerState::SERVO) engageAndGoRound();
    motion_.set(loss.apply);
    ASSERT_TRUE(waitForReason(loss.reason)) << loss.name << ": " << cart_.state().reason;
    EXPECT_TRUE(cart_.stands()) << loss.name;
    motion_.set([](MotionWords& w) { w = MotionWords{}, w.message = viewOff(0.0, 0.0); });
    ASSERT_TRUE(waitFor([this] {
      const std::string state = cart_.state().state;
      return state == ControllerState::SERVO || state == ControllerState::LOST;
    })) << loss.name;
  }
}

TEST_F(ControllerParallel, WithoutPosesItStands) {
  engageAndGoRound();
  cart_.set([](Feed& feed) { feed.tf = false; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::HOLD)) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
}

// The fake cart's scope and its view stand, whatever is commanded.
TEST_F(ControllerParallel, WhereNothingMovesTheNormalDoesNotBecomeKnown) {
  engageAndGoRound();
  ASSERT_TRUE(waitForReason("did not become known")) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
  ASSERT_TRUE(cart_.waitForState(ControllerState::LOST));
  EXPECT_TRUE(cart_.engageWhenReady()) << "the circle can be tried again: " << cart_.answer();
}

TEST_F(ControllerParallel, TimeThatJumpsBackIsAFault) {
  engageAndGoRound();
  motion_.set([](MotionWords& w) { w.stamp_offset = -1.0; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::FAULT)) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
}

// The last one: the calibration that comes back would end an engagement of the next.
TEST_F(ControllerParallel, AnotherCalibrationEndsIt) {
  engageAndGoRound();
  motion_.set([](MotionWords& w) { w.focal_length = 600.0; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << cart_.state().reason;
  EXPECT_TRUE(waitForReason("camera_info has another calibration")) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_parallel");
  return RUN_ALL_TESTS();
}
