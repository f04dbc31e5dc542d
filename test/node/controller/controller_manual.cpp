// Manual drive: somebody's four velocities move the scope, without a tracker, through the same safety states.
#include <laparoscope_servo/SelectTask.h>

#include <limits>

#include "fake_cart.h"

namespace laparoscope_servo {
namespace {

ScopeVelocity velocity(double pan, double insertion) {
  ScopeVelocity message;
  message.pan = pan;
  message.insertion = insertion;
  return message;
}

// Sliders: repeat what they are set to, at 20 Hz.
class Sliders {
 public:
  Sliders() : publisher_(node_.advertise<ScopeVelocity>("/controller/manual", 1)) {
    thread_ = std::thread([this] {
      while (!end_) {
        {
          const std::lock_guard<std::mutex> lock(mutex_);
          if (on_) publisher_.publish(message_);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      }
    });
  }
  ~Sliders() { end(); }
  void end() {
    end_ = true;
    if (thread_.joinable()) thread_.join();
  }
  void set(const ScopeVelocity& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    message_ = message;
    on_ = true;
    publisher_.publish(message_);
  }
  void fallSilent() {
    const std::lock_guard<std::mutex> lock(mutex_);
    on_ = false;
  }
  bool connected() const { return publisher_.getNumSubscribers() > 0; }

 private:
  ros::NodeHandle node_;
  ros::Publisher publisher_;
  std::mutex mutex_;
  ScopeVelocity message_;
  bool on_ = false;
  std::atomic<bool> end_{false};
  std::thread thread_;
};

class ControllerManual : public ::testing::Test {
 protected:
  static FakeCart& cart() {
    static FakeCart instance;
    return instance;
  }
  static Sliders& sliders() {
    static Sliders instance;
    return instance;
  }
  static void TearDownTestSuite() {
    sliders().end();
    cart().end();
  }

  // Disengaged, to be driven by hand, no tracker.
  void SetUp() override {
    sliders_.fallSilent();
    cart_.strike([](Feed& feed) { feed = Feed{}, feed.task_error = false; });
    ASSERT_TRUE(cart_.waitForController());
    ASSERT_TRUE(waitFor([this] { return sliders_.connected(); }));
    bool success = false;
    cart_.engage(false, success);
    select("MANUAL", success);
    ASSERT_TRUE(success);
    ASSERT_TRUE(waitFor([this] { return cart_.state().task == "MANUAL" && cart_.state().state == "IDLE"; }));
  }

  std::string select(const std::string& task, bool& success) {
    SelectTask call;
    call.request.task = task;
    success = select_.call(call) && call.response.success;
    return call.response.message;
  }

  ScopeVelocity command() { return cart_.nextCommands(1).back(); }

  // Waits for a command that is driven to the right, at full speed or nearly so.
  void engageAndDrive() {
    ASSERT_TRUE(cart_.engageWhenReady());
    ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO)) << cart_.state().reason;
    ASSERT_TRUE(drive(velocity(0.5, 0.0)));
    ASSERT_TRUE(waitFor([this] { return command().pan > 0.0999; }));
  }

  // From rest: what is deflected from the beginning does not count.
  bool drive(const ScopeVelocity& wanted) {
    return waitFor([&] {
      sliders_.set(velocity(0.0, 0.0));
      cart_.nextCommands(3);
      sliders_.set(wanted);
      return cart_.moves() || cart_.moves();
    });
  }

  void expectStandingUntilReleased() {
    ASSERT_TRUE(waitFor([this] { return cart_.state().caution.find("release the stick") != std::string::npos; }))
        << cart_.state().caution;
    EXPECT_TRUE(cart_.stands());
    EXPECT_EQ(cart_.state().state, ControllerState::SERVO);
  }

  FakeCart& cart_ = cart();
  Sliders& sliders_ = sliders();
  ros::ServiceClient select_ = ros::NodeHandle().serviceClient<SelectTask>("/controller/select_task");
};

TEST_F(ControllerManual, IsDrivenWithinTheLimits) {
  engageAndDrive();
  for (const ScopeVelocity& command : cart_.nextCommands(20)) {
    EXPECT_GT(command.pan, 0.0);
    EXPECT_LE(command.pan, 0.1 * (1.0 + 1e-9));
    EXPECT_EQ(command.tilt, 0.0);
    EXPECT_EQ(command.spin, 0.0);
    EXPECT_EQ(command.insertion, 0.0);
  }
  sliders_.set(velocity(0.0, -0.005));
  EXPECT_TRUE(waitFor([this] {
    const ScopeVelocity now = command();
    return now.pan == 0.0 && std::abs(now.insertion + 0.0054) < 1e-9;  // the dead zone's width is added
  }));
}

TEST_F(ControllerManual, StandsUntilItIsEngaged) {
  sliders_.set(velocity(0.5, 0.0));
  EXPECT_TRUE(cart_.stands());
  EXPECT_EQ(cart_.state().state, ControllerState::IDLE);
}

TEST_F(ControllerManual, SilentSlidersStopAndNeedNoEngagingAgain) {
  engageAndDrive();
  sliders_.fallSilent();
  ASSERT_TRUE(waitFor([this] { return isZero(command()); }));
  EXPECT_TRUE(cart_.stands());
  EXPECT_EQ(cart_.state().state, ControllerState::SERVO);
  sliders_.set(velocity(0.05, 0.0));
  expectStandingUntilReleased();
  EXPECT_TRUE(drive(velocity(0.05, 0.0)));
}

TEST_F(ControllerManual, AStickThatIsHeldSetsNothingInMotion) {
  sliders_.set(velocity(0.05, 0.0));
  ASSERT_TRUE(cart_.engageWhenReady());
  expectStandingUntilReleased();
  EXPECT_TRUE(drive(velocity(0.05, 0.0)));
  cart_.strike([](Feed& feed) { feed.robot_state = "PAUSED"; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::HOLD));
  cart_.strike([](Feed& feed) { feed.robot_state = "ENABLED"; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO));
  expectStandingUntilReleased();
  EXPECT_TRUE(drive(velocity(0.05, 0.0)));
  cart_.strike([](Feed& feed) { feed.pressed = false; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::ARMED));
  cart_.strike([](Feed& feed) { feed.pressed = true; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO));
  expectStandingUntilReleased();
}

TEST_F(ControllerManual, AnOldStampAndOneFromTheFutureCountAsSilence) {
  for (const double offset : {-0.3, 1.0, 1e6}) {
    engageAndDrive();
    ScopeVelocity off = velocity(0.05, 0.0);
    off.header.stamp = ros::Time::now() + ros::Duration(offset);
    sliders_.set(off);
    ASSERT_TRUE(waitFor([this] { return isZero(command()); })) << offset;
    EXPECT_TRUE(cart_.stands()) << offset;
  }
}

TEST_F(ControllerManual, WhatIsNotFiniteStops) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    engageAndDrive();
    sliders_.set(velocity(0.05, bad));
    ASSERT_TRUE(waitFor([this] { return isZero(command()); }));
    EXPECT_TRUE(cart_.stands());
    EXPECT_EQ(cart_.state().state, ControllerState::SERVO);
  }
}

TEST_F(ControllerManual, StopsForTheSameReasons) {
  struct Case {
    std::function<void(Feed&)> change;
    std::string state;
  };
  const std::vector<Case> cases{{[](Feed& feed) { feed.pressed = false; }, "ARMED"},
                                {[](Feed& feed) { feed.robot_state = "PAUSED"; }, "HOLD"},
                                {[](Feed& feed) { feed.robot_state = "DISABLED"; }, "LOST"},
                                {[](Feed& feed) { feed.tf = false; }, "HOLD"},
                                {[](Feed& feed) { feed.lateral = 0.03; }, "FAULT"}};
  for (const Case& one : cases) {
    engageAndDrive();
    cart_.strike(one.change);
    ASSERT_TRUE(cart_.waitForState(one.state)) << one.state << ": " << cart_.state().reason;
    EXPECT_TRUE(cart_.stands()) << one.state;
    cart_.strike([](Feed& feed) { feed = Feed{}, feed.task_error = false; });
  }
}

TEST_F(ControllerManual, AnotherTaskStartsFromRest) {
  // What a tracker says in between does not count, not even that its time jumped back.
  cart_.strike([](Feed& feed) { feed.task_error = true, feed.message = offTarget(); });
  engageAndDrive();
  cart_.strike([](Feed& feed) { feed.stamp_offset = -0.1; });
  EXPECT_GT(command().pan, 0.0);
  cart_.strike([](Feed& feed) { feed.message.x = feed.message.e_v.x = -0.5; });  // the region is on the left
  cart_.nextCommands(15);  // until its stamps are newer than those before the step back
  for (const char* task : {"HOLD_VIEW", "MANUAL"}) {
    cart_.takeCommands();
    bool success = false;
    const std::string message = select(task, success);
    EXPECT_TRUE(success);
    EXPECT_NE(message.find(task), std::string::npos) << message;
    EXPECT_NE(message.find("SERVO"), std::string::npos) << message;
    const double sign = std::string(task) == "MANUAL" ? 1.0 : -1.0;
    if (sign > 0.0) {
      expectStandingUntilReleased();
      cart_.takeCommands();
      sliders_.set(velocity(0.0, 0.0));
      ASSERT_TRUE(waitFor([this] { return cart_.state().caution.empty(); }));
      sliders_.set(velocity(0.5, 0.0));
    }
    std::vector<ScopeVelocity> commands;
    ASSERT_TRUE(waitFor([&] {
      for (const ScopeVelocity& one : cart_.takeCommands()) commands.push_back(one);
      return !commands.empty() && sign * commands.back().pan > 0.05;
    }));
    EXPECT_EQ(cart_.state().task, task);
    // Between the one task and the other there is a zero, and what follows it begins slowly.
    std::size_t rest = commands.size() - 1;
    while (rest > 0 && !isZero(commands[rest])) --rest;
    ASSERT_TRUE(isZero(commands[rest]));
    ASSERT_LT(rest + 1, commands.size());
    for (std::size_t k = 0; k < commands.size(); ++k) EXPECT_EQ(sign * commands[k].pan > 0.0, k > rest) << k;
    EXPECT_LT(std::abs(commands[rest + 1].pan), 0.05);
  }
}

TEST_F(ControllerManual, HoldsAViewOnlyWithATracker) {
  engageAndDrive();
  bool success = false;
  select("HOLD_VIEW", success);
  EXPECT_TRUE(success);
  // At the latest when what another test's tracker said has grown old.
  ASSERT_TRUE(cart_.waitForState(ControllerState::HOLD));
  EXPECT_TRUE(cart_.stands());
  select("MANUAL", success);
  ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO));
  EXPECT_TRUE(drive(velocity(0.05, 0.0)));
}

TEST_F(ControllerManual, RefusesATaskThatItDoesNotKnow) {
  engageAndDrive();
  for (const char* task : {"", "manual", "DANCE"}) {
    bool success = true;
    const std::string message = select(task, success);
    EXPECT_FALSE(success);
    EXPECT_NE(message.find("HOLD_VIEW, MANUAL, STABILISE, CENTRE_TIP, FOLLOW, POINTS, POSITION or PARALLEL"),
              std::string::npos)
        << message;
  }
  EXPECT_GT(command().pan, 0.0);
  EXPECT_EQ(cart_.state().task, "MANUAL");
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_manual");
  return RUN_ALL_TESTS();
}
