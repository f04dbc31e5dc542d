// ROS time that stops or jumps, as with a bag that is paused or looped: the arm stands still.
#include <rosgraph_msgs/Clock.h>

#include "stopping.h"

namespace laparoscope_servo {
namespace {

// Publishes /clock at 100 Hz.
class Clock {
 public:
  Clock() : publisher_(node_.advertise<rosgraph_msgs::Clock>("/clock", 1)) {
    thread_ = std::thread([this] {
      while (!end_) {
        advance(running_ ? 0.01 : 0.0);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    });
  }
  ~Clock() { end(); }
  void end() {
    end_ = true;
    if (thread_.joinable()) thread_.join();
  }
  void run(bool on) { running_ = on; }
  // When it did, s on the steady clock.
  double jump(double seconds) {
    const double now = steadyNow();
    advance(seconds);
    return now;
  }

 private:
  void advance(double seconds) {
    const std::lock_guard<std::mutex> lock(mutex_);
    time_ += seconds;
    rosgraph_msgs::Clock message;
    message.clock = ros::Time(time_);
    publisher_.publish(message);
  }

  ros::NodeHandle node_;
  ros::Publisher publisher_;
  std::mutex mutex_;
  double time_ = 1000.0;  // s
  std::atomic<bool> running_{true};
  std::atomic<bool> end_{false};
  std::thread thread_;
};

class ControllerTime : public ::testing::Test {
 protected:
  // One for all tests: a new one would start again, and that is a jump.
  static Clock& clock() {
    static Clock instance;
    return instance;
  }
  static FakeCart& cart() {
    static FakeCart instance;
    return instance;
  }
  static void TearDownTestSuite() {
    clock().end();
    cart().end();
  }

  void SetUp() override {
    clock_.run(true);
    ASSERT_TRUE(cart_.waitForController());
    ASSERT_TRUE(cart_.engageWhenReady()) << cart_.answer();
    ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO)) << cart_.state().reason;
    ASSERT_TRUE(waitFor([this] { return cart_.moves(); }));
  }

  Clock& clock_ = clock();
  FakeCart& cart_ = cart();
};

TEST_F(ControllerTime, TimeThatJumpsBackIsAFault) {
  std::vector<double> times;
  for (int k = 0; k < 10; ++k) {
    waitForAPhase(k, 10);
    const double jumped = clock_.jump(-50.0);
    ASSERT_TRUE(cart_.waitForState(ControllerState::FAULT));
    EXPECT_NE(cart_.state().reason.find("jumped back"), std::string::npos) << cart_.state().reason;
    EXPECT_TRUE(waitFor([&] { return cart_.stoodAt() > jumped; }));
    for (const ScopeVelocity& command : cart_.nextCommands(3)) EXPECT_TRUE(isZero(command));
    times.push_back(cart_.stoodAt() - jumped);
    bool success = true;
    EXPECT_NE(cart_.engage(true, success).find("disengage"), std::string::npos);
    EXPECT_FALSE(success);
    // What came before the jump is forgotten; with what comes after it, one may engage again.
    cart_.engage(false, success);
    ASSERT_TRUE(cart_.engageWhenReady()) << cart_.answer();
    ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO)) << cart_.state().reason;
    ASSERT_TRUE(waitFor([this] { return cart_.moves(); }));
  }
  printStoppingTimes("ROS time jumped back", "FAULT", times);
}

// Of two connections one is always later.
TEST_F(ControllerTime, TransformsFromBeforeTheJumpDoNotBlockWhatFollows) {
  clock_.jump(-50.0);
  ASSERT_TRUE(cart_.waitForState(ControllerState::FAULT));
  cart_.strike([](Feed& feed) { feed.tf_stamp_offset = 50.0; });
  cart_.set([](Feed& feed) { feed.tf_stamp_offset = 0.0; });
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // until the controller has it
  bool success = false;
  cart_.engage(false, success);
  EXPECT_TRUE(cart_.engageWhenReady()) << cart_.answer();
  EXPECT_TRUE(cart_.waitForState(ControllerState::SERVO)) << cart_.state().reason;
  EXPECT_TRUE(waitFor([this] { return cart_.moves(); }));
}

TEST_F(ControllerTime, TimeThatStopsHolds) {
  clock_.run(false);
  ASSERT_TRUE(cart_.waitForState(ControllerState::HOLD));
  EXPECT_NE(cart_.state().reason.find("older than"), std::string::npos) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
  clock_.run(true);
  EXPECT_TRUE(cart_.waitForState(ControllerState::SERVO));
}

TEST_F(ControllerTime, TimeThatJumpsAheadDoesNotKillTheNode) {
  clock_.jump(1000.0);
  EXPECT_TRUE(cart_.nextCommands(5).size() >= 5);
  EXPECT_TRUE(waitFor([this] { return cart_.engageWhenReady(0.1) && cart_.moves(); }));
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_time");
  return RUN_ALL_TESTS();
}
