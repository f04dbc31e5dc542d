// The task POINTS over topics: it goes by points of texture alone; what that lacks is refused by name, or a HOLD.
#include <laparoscope_servo/SelectTask.h>

#include "controller_fixture.h"
#include "motion_feed.h"

namespace laparoscope_servo {
namespace {

class ControllerPoints : public ControllerFixture {
 protected:
  static MotionFeed& feed() {
    static MotionFeed instance("/points_features");
    return instance;
  }
  static void TearDownTestSuite() {
    feed().end();
    ControllerFixture::TearDownTestSuite();
  }

  void SetUp() override {
    show(pointsOff(40.0, -20.0));
    ControllerFixture::SetUp();
    // The region of interest is silent: nothing of it is needed.
    cart_.set([](Feed& feed) { feed.task_error = false; });
    select(SelectTask::Request::POINTS);
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
};

struct Loss {
  const char* name;
  std::function<void(MotionWords&)> apply;
  const char* reason;
};

const Loss kLosses[] = {
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
  for (const Loss& loss : kLosses) {
    engageAndMove();
    feed_.set(loss.apply);
    ASSERT_TRUE(waitForReason(loss.reason)) << loss.name << ": " << cart_.state().reason;
    EXPECT_TRUE(cart_.stands()) << loss.name;
    ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << loss.name << ": " << cart_.state().reason;
    show(pointsOff(40.0, -20.0));
  }
}

TEST_F(ControllerPoints, EachLossIsRefusedByName) {
  for (const Loss& loss : kLosses) {
    bool success = false;
    ASSERT_TRUE(cart_.engageWhenReady()) << cart_.answer();  // nothing is missing yet
    cart_.engage(false, success);
    feed_.set(loss.apply);
    EXPECT_TRUE(waitForRefusal(loss.reason)) << loss.name << ": " << cart_.answer();
    show(pointsOff(40.0, -20.0));
  }
}

TEST_F(ControllerPoints, IsLeftAndTakenUpAgain) {
  engageAndMove();
  select(SelectTask::Request::HOLD_VIEW);
  EXPECT_TRUE(waitForReason("task error")) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
  select(SelectTask::Request::POINTS);
  bool success = false;
  cart_.engage(false, success);
  ASSERT_TRUE(cart_.waitForState(ControllerState::IDLE));
  engageAndMove();
}

TEST_F(ControllerPoints, AnotherCalibrationEndsIt) {
  // There and back, so that the next test has the first one.
  for (const double focal_length : {600.0, 500.0}) {
    engageAndMove();
    feed_.set([=](MotionWords& w) { w.focal_length = focal_length; });
    ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << cart_.state().reason;
    EXPECT_TRUE(waitForReason("camera_info has another calibration")) << cart_.state().reason;
    EXPECT_TRUE(cart_.stands());
  }
}

TEST_F(ControllerPoints, TimeThatJumpsBackIsAFault) {
  engageAndMove();
  feed_.set([](MotionWords& w) { w.stamp_offset = -1.0; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::FAULT)) << cart_.state().reason;
  EXPECT_NE(cart_.state().reason.find("points of the view jumped back"), std::string::npos) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
}

TEST_F(ControllerPoints, WithoutTheScopesPoseItStands) {
  engageAndMove();
  cart_.set([](Feed& feed) { feed.tf = false; });
  ASSERT_TRUE(waitFor([this] { return cart_.state().state == ControllerState::HOLD; })) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_points");
  return RUN_ALL_TESTS();
}
