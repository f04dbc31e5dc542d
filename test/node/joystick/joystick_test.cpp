// The node `joystick` as a process, before a named pipe into which the test writes what a device would say.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <laparoscope_servo/ScopeVelocity.h>
#include <linux/joystick.h>
#include <std_msgs/Bool.h>
#include <sys/stat.h>

#include <memory>

#include "node/sim/node_bench.h"

namespace laparoscope_servo::test {
namespace {

constexpr int kButton = 5;

class Joystick : public testing::Test {
 protected:
  ~Joystick() override {
    unplug();
    ros::param::del("/joystick");
  }

  void start() {
    ros::param::set("/joystick/device", pipe_);
    node_process_ = std::make_unique<ChildProcess>(JOYSTICK, std::vector<std::string>{"__name:=joystick"}, log());
    dead_man_ = std::make_unique<Recorder<std_msgs::Bool>>(node_, "dead_man");
    manual_ = std::make_unique<Recorder<ScopeVelocity>>(node_, "controller/manual");
    ASSERT_TRUE(spinUntil([this] { return dead_man_->connected() && manual_->connected(); }));
  }
  // The other end is open once the node has found the device.
  void plugIn(bool pressed) {
    ASSERT_TRUE(spinUntil([this] { return (device_ = ::open(pipe_.c_str(), O_WRONLY | O_NONBLOCK)) >= 0; }));
    std::vector<js_event> events;
    for (const int axis : {0, 1, 2, 3, 4, 5}) events.push_back(event(JS_EVENT_AXIS | JS_EVENT_INIT, axis, 0));
    events.push_back(event(JS_EVENT_BUTTON | JS_EVENT_INIT, kButton, pressed ? 1 : 0));
    ASSERT_EQ(::write(device_, events.data(), events.size() * sizeof(js_event)),
              static_cast<ssize_t>(events.size() * sizeof(js_event)));
  }
  void unplug() {
    if (device_ >= 0) ::close(device_);
    device_ = -1;
  }
  static js_event event(int type, int number, int value) {
    return {0, static_cast<std::int16_t>(value), static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(number)};
  }
  void send(int type, int number, int value) const {
    const js_event sent = event(type, number, value);
    ASSERT_EQ(::write(device_, &sent, sizeof sent), static_cast<ssize_t>(sizeof sent));
  }
  bool logHas(const std::string& text) const { return contents(log()).find(text) != std::string::npos; }
  bool isReady() const { return logHas("is ready"); }
  std::string log() const { return folder_.file("joystick.log"); }
  bool lastSaid(bool pressed) const { return !dead_man_->all.empty() && (dead_man_->all.back()->data != 0) == pressed; }

  test_support::TemporaryFolder folder_;
  std::string pipe_ = [this] {
    const std::string name = folder_.file("js0");
    ::mkfifo(name.c_str(), 0600);
    return name;
  }();
  ros::NodeHandle node_;
  std::unique_ptr<ChildProcess> node_process_;
  std::unique_ptr<Recorder<std_msgs::Bool>> dead_man_;
  std::unique_ptr<Recorder<ScopeVelocity>> manual_;
  int device_ = -1;
};

TEST_F(Joystick, HoldsDrivesAndLetsGo) {
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(plugIn(false));
  ASSERT_TRUE(spinUntil([this] { return isReady(); })) << contents(log());
  EXPECT_TRUE(dead_man_->all.empty());
  EXPECT_TRUE(manual_->all.empty());

  send(JS_EVENT_BUTTON, kButton, 1);
  ASSERT_TRUE(spinUntil([this] { return dead_man_->all.size() >= 4 && manual_->all.size() >= 4; }));
  EXPECT_FALSE(dead_man_->all[0]->data) << "taken anew";
  EXPECT_TRUE(dead_man_->all[1]->data);
  EXPECT_EQ(manual_->all[0]->pan, 0.0);
  EXPECT_FALSE(manual_->all[0]->header.stamp.isZero());

  send(JS_EVENT_AXIS, 0, 32767);
  ASSERT_TRUE(spinUntil([this] { return manual_->all.back()->pan == 0.1; }));
  send(JS_EVENT_BUTTON, kButton, 0);
  ASSERT_TRUE(spinUntil([this] { return lastSaid(false) && manual_->all.back()->pan == 0.0; }));
  EXPECT_TRUE(node_process_->isRunning());
}

TEST_F(Joystick, UnpluggedWhileHeldItLetsGoAndMayComeBackHeldWithoutAWord) {
  ASSERT_NO_FATAL_FAILURE(start());
  EXPECT_TRUE(spinUntil([this] { return logHas("is silent"); })) << contents(log());
  ASSERT_NO_FATAL_FAILURE(plugIn(false));
  ASSERT_TRUE(spinUntil([this] { return isReady(); })) << contents(log());
  send(JS_EVENT_BUTTON, kButton, 1);
  ASSERT_TRUE(spinUntil([this] { return lastSaid(true); }));
  unplug();
  ASSERT_TRUE(spinUntil([this] { return lastSaid(false); }));
  EXPECT_TRUE(spinUntil([this] { return logHas("has ended"); }));

  ASSERT_NO_FATAL_FAILURE(plugIn(true));
  ASSERT_TRUE(spinUntil([this] { return logHas("from the start"); })) << contents(log());
  EXPECT_TRUE(lastSaid(false));
  send(JS_EVENT_BUTTON, kButton, 0);
  ASSERT_TRUE(
      spinUntil([this] { return contents(log()).rfind("is ready") > contents(log()).rfind("from the start"); }));
  send(JS_EVENT_BUTTON, kButton, 1);
  EXPECT_TRUE(spinUntil([this] { return lastSaid(true); }));
}

TEST_F(Joystick, AnswersAFileThatIsNoJoystickWithSilenceAndAReason) {
  ASSERT_NO_FATAL_FAILURE(start());
  ASSERT_NO_FATAL_FAILURE(plugIn(false));
  send(77, 3, 3);
  EXPECT_TRUE(spinUntil([this] { return logHas("is no event of the joystick API"); })) << contents(log());
  EXPECT_TRUE(node_process_->isRunning());
  EXPECT_TRUE(dead_man_->all.empty());
}

TEST_F(Joystick, RefusesParametersThatCannotBe) {
  ros::param::set("/joystick/dead_man/button", -1);
  ros::param::set("/joystick/nutral", 0.2);
  ChildProcess process(JOYSTICK, {"__name:=joystick"}, log());
  EXPECT_EQ(process.exitStatus(20.0), 1);
  EXPECT_TRUE(logHas("only_while_held") && logHas("nutral")) << contents(log());
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "joystick_test");
  ros::NodeHandle keeps_ros_up;
  signal(SIGPIPE, SIG_IGN);
  return RUN_ALL_TESTS();
}
