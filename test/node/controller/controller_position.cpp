// The task POSITION over topics: it goes by the homography of the region; what that lacks is refused by name, or a
// HOLD.
#include <laparoscope_servo/SelectTask.h>

#include "controller_fixture.h"
#include "homography_feed.h"

namespace laparoscope_servo {
namespace {

class ControllerPosition : public ControllerFixture {
 protected:
  static HomographyFeed& feed() {
    static HomographyFeed instance;
    return instance;
  }
  static void TearDownTestSuite() {
    feed().end();
    ControllerFixture::TearDownTestSuite();
  }

  void SetUp() override {
    show(regionOff(0.08, -0.04));
    ControllerFixture::SetUp();
    // Of the task error nothing counts but the region's place.
    cart_.set([](Feed& feed) { feed.message.reference_stamp = ros::Time(3); });
    cart_.nextCommands(10);  // until the controller has it
    select(SelectTask::Request::POSITION);
  }
  void select(const std::string& task) {
    SelectTask call;
    call.request.task = task;
    ASSERT_TRUE(ros::service::call("/controller/select_task", call) && call.response.success) << call.response.message;
    ASSERT_TRUE(waitFor([&] { return cart_.state().task == task; }));
  }
  void show(const Homography& homography) {
    feed_.set([&](PositionWords& words) { words = PositionWords{}, words.message = homography; });
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

  HomographyFeed& feed_ = feed();
};

struct Loss {
  const char* name;
  std::function<void(PositionWords&)> apply;
  const char* reason;
};

const Loss kLosses[] = {
    {"silent", [](PositionWords& w) { w.speaks = false; }, "silent"},
    {"lost", [](PositionWords& w) { w.message.state = Homography::LOST; }, "not valid"},
    {"without intrinsics", [](PositionWords& w) { w.message.has_intrinsics = 0; }, "no intrinsics"},
    {"of another region", [](PositionWords& w) { w.message.reference_stamp = ros::Time(9); }, "place of the region"},
    {"little is seen", [](PositionWords& w) { w.message.visible_fraction = 0.1; }, "occluded"},
    {"not a number", [](PositionWords& w) { w.message.h[4] = std::nan(""); }, "of no plane"},
    {"stamped ahead", [](PositionWords& w) { w.stamp_offset = 60.0; }, "future"},
    {"without a stamp", [](PositionWords& w) { w.without_stamp = true; }, "no stamp"},
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
  for (const Loss& loss : kLosses) {
    engageAndMove();
    feed_.set(loss.apply);
    ASSERT_TRUE(waitForReason(loss.reason)) << loss.name << ": " << cart_.state().reason;
    EXPECT_TRUE(cart_.stands()) << loss.name;
    ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << loss.name << ": " << cart_.state().reason;
    show(regionOff(0.08, -0.04));
  }
}

TEST_F(ControllerPosition, EachLossIsRefusedByName) {
  for (const Loss& loss : kLosses) {
    bool success = false;
    ASSERT_TRUE(cart_.engageWhenReady()) << cart_.answer();  // nothing is missing yet
    cart_.engage(false, success);
    feed_.set(loss.apply);
    EXPECT_TRUE(waitForRefusal(loss.reason)) << loss.name << ": " << cart_.answer();
    show(regionOff(0.08, -0.04));
  }
}

TEST_F(ControllerPosition, IsLeftAndTakenUpAgain) {
  engageAndMove();
  select(SelectTask::Request::HOLD_VIEW);
  select(SelectTask::Request::POSITION);
  bool success = false;
  cart_.engage(false, success);
  ASSERT_TRUE(cart_.waitForState(ControllerState::IDLE));
  engageAndMove();
}

TEST_F(ControllerPosition, TimeThatJumpsBackIsAFault) {
  engageAndMove();
  feed_.set([](PositionWords& w) { w.stamp_offset = -1.0; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::FAULT)) << cart_.state().reason;
  EXPECT_NE(cart_.state().reason.find("homography of the region jumped back"), std::string::npos)
      << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
}

TEST_F(ControllerPosition, WithoutTheScopesPoseItStands) {
  engageAndMove();
  cart_.set([](Feed& feed) { feed.tf = false; });
  ASSERT_TRUE(waitFor([this] { return cart_.state().state == ControllerState::HOLD; })) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_position");
  return RUN_ALL_TESTS();
}
