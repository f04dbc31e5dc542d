// The task CENTRE_TIP over topics: it goes by the tip of one instrument alone, and whatever that lacks is a HOLD.
#include <laparoscope_servo/SelectTask.h>

#include "controller_fixture.h"
#include "motion_feed.h"

namespace laparoscope_servo {
namespace {

class ControllerCentreTip : public ControllerFixture {
 protected:
  static MotionFeed& instrument() {
    static MotionFeed instance("/instrument_features");
    return instance;
  }
  static void TearDownTestSuite() {
    instrument().end();
    ControllerFixture::TearDownTestSuite();
  }

  void SetUp() override {
    show(tipAt(440.0, 240.0));  // outside of the zone, to the right
    ControllerFixture::SetUp();
    // The region of interest is silent: nothing of it is needed.
    cart_.set([](Feed& feed) { feed.task_error = false; });
    SelectTask call;
    call.request.task = SelectTask::Request::CENTRE_TIP;
    ASSERT_TRUE(ros::service::call("/controller/select_task", call) && call.response.success) << call.response.message;
    ASSERT_TRUE(waitFor([this] { return cart_.state().task == ControllerState::CENTRE_TIP; }));
  }
  void show(const TrackedFeatures& features) {
    instrument_.set([&](MotionWords& words) { words = MotionWords{}, words.message = features; });
  }
  void engageAndCentre() {
    ASSERT_TRUE(cart_.engageWhenReady()) << cart_.answer();
    ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO)) << cart_.state().reason;
    ASSERT_TRUE(waitFor([this] { return cart_.moves(); }));
  }
  bool waitForReason(const std::string& reason) {
    return waitFor([&] { return cart_.state().reason.find(reason) != std::string::npos; });
  }

  MotionFeed& instrument_ = instrument();
};

TEST_F(ControllerCentreTip, PansToATipOutsideItsZoneAndRestsWithinIt) {
  engageAndCentre();
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
  engageAndCentre();
  show(tipAt(200.0, 240.0, "2"));
  ASSERT_TRUE(waitForReason("not valid")) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
  ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << cart_.state().reason;
}

struct Loss {
  const char* name;
  std::function<void(MotionWords&)> apply;
  const char* reason;
};

TEST_F(ControllerCentreTip, EachLossStopsIt) {
  const Loss losses[] = {
      {"silent", [](MotionWords& w) { w.motion = false; }, "silent"},
      {"lost", [](MotionWords& w) { w.message.features[0].state = TrackedFeatures::LOST; }, "not valid"},
      {"no instrument", [](MotionWords& w) { w.message.features.clear(); }, "not valid"},
      {"leaves", [](MotionWords& w) { w.message.features[0].parameters[0] = 600.0; }, "the tip leaves"},
      {"uncertain", [](MotionWords& w) { w.message.features[0].expected_error = 9.0; }, "centre_tip/max_error"},
      {"not a number", [](MotionWords& w) { w.message.features[0].parameters[1] = std::nan(""); }, "not finite"},
      {"stamped ahead", [](MotionWords& w) { w.stamp_offset = 60.0; }, "future"},
      {"without a stamp", [](MotionWords& w) { w.without_stamp = true; }, "no stamp"},
  };
  for (const Loss& loss : losses) {
    engageAndCentre();
    instrument_.set(loss.apply);
    ASSERT_TRUE(waitForReason(loss.reason)) << loss.name << ": " << cart_.state().reason;
    EXPECT_TRUE(cart_.stands()) << loss.name;
    ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << loss.name << ": " << cart_.state().reason;
    show(tipAt(440.0, 240.0));
  }
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_centre_tip");
  return RUN_ALL_TESTS();
}
