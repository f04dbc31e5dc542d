// Somebody else publishes what the controller listens to: nothing of it counts, and it is said.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/TwistStamped.h>
#include <laparoscope_servo/SelectTask.h>

#include <limits>
#include <memory>

#include "controller_fixture.h"
#include "system/aesop/child_process.h"

namespace laparoscope_servo {
namespace {

using test::ChildProcess;

// The opposite of what the fake cart says, and that all is well, on every topic.
class Stranger {
 public:
  Stranger() {
    ros::NodeHandle own("~");
    own.getParam("rate", rate_);
    own.getParam("pan", pan_);
    own.getParam("only_manual", only_manual_);
    manual_ = node_.advertise<ScopeVelocity>("/controller/manual", 1);
    if (only_manual_) return;
    task_error_ = node_.advertise<TaskError>("/task_error", 1);
    robot_ = node_.advertise<OperatingState>("/operating_state", 1);
    velocity_ = node_.advertise<geometry_msgs::TwistStamped>("/measured_cv", 1);
    dead_man_ = node_.advertise<std_msgs::Bool>("/dead_man", 1);
  }
  void run() {
    ros::WallRate rate(rate_);
    for (; ros::ok(); rate.sleep()) publish();
  }

 private:
  void publish() {
    ScopeVelocity manual;
    manual.pan = pan_;
    manual_.publish(manual);
    if (only_manual_) return;
    TaskError task_error = offTarget();
    task_error.header.stamp = ros::Time::now();
    task_error.x = task_error.e_v.x = -0.5 + 1e-9 * ++count_;
    task_error_.publish(task_error);
    OperatingState robot;
    robot.header.stamp = ros::Time::now();
    robot.state = "ENABLED";
    robot.enables = 1;
    robot_.publish(robot);
    geometry_msgs::TwistStamped velocity;
    velocity.header.stamp = ros::Time::now();
    velocity.header.frame_id = "aesop_base";
    velocity_.publish(velocity);
    std_msgs::Bool pressed;
    pressed.data = 1;
    dead_man_.publish(pressed);
  }

  ros::NodeHandle node_;
  ros::Publisher manual_, task_error_, robot_, velocity_, dead_man_;
  double rate_ = 100.0, pan_ = -0.5;
  bool only_manual_ = false;
  int count_ = 0;
};

class ControllerInputs : public ControllerFixture {
 protected:
  static std::unique_ptr<ChildProcess> stranger(const std::string& name, double rate, double pan = -0.5,
                                                bool only_manual = false) {
    return std::make_unique<ChildProcess>(
        "/proc/self/exe", std::vector<std::string>{"publish", "__name:=" + name, "_rate:=" + std::to_string(rate),
                                                   "_pan:=" + std::to_string(pan),
                                                   std::string("_only_manual:=") + (only_manual ? "true" : "false")});
  }
  static ros::Publisher& manual() {
    static ros::Publisher publisher = ros::NodeHandle().advertise<ScopeVelocity>("/controller/manual", 1);
    return publisher;
  }

  void select(const std::string& task) {
    SelectTask call;
    call.request.task = task;
    ASSERT_TRUE(ros::service::call("/controller/select_task", call) && call.response.success);
  }
  // What the controller says of an input.
  std::string said(const std::string& key) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& pair : status_.values) {
      if (pair.key == key) return pair.value;
    }
    return "";
  }
  // s; not a number as long as the controller has not said it.
  double manualAge() {
    const std::string age = said("age of the manual command [s]");
    return age.empty() ? std::numeric_limits<double>::quiet_NaN() : std::strtod(age.c_str(), nullptr);
  }
  // Somebody's manual commands come.
  bool speaks() { return manualAge() < 0.2; }
  // Nobody is bound any more, also no process that has ended and whose last messages were still waiting.
  bool isSilent() { return manualAge() > 1.0; }
  // And they count.
  bool isDriven() { return speaks() && cart_.state().caution.empty(); }
  bool waitForRefusals(const std::string& what) {
    return waitFor([&] { return std::atoi(said(what + ": refused for their sender").c_str()) > 20; }, 20.0);
  }
  std::string summary() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return status_.message;
  }

 private:
  std::mutex mutex_;
  diagnostic_msgs::DiagnosticStatus status_;
  ros::Subscriber diagnostics_ = ros::NodeHandle().subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10, [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
        const std::lock_guard<std::mutex> lock(mutex_);
        for (const auto& status : message->status) {
          if (status.name == "controller: control") status_ = status;
        }
      });
};

TEST_F(ControllerInputs, AStrangerMovesNothingAndKeepsNothingMoving) {
  engageAndMove();
  const auto other = stranger("stranger", 100.0);
  for (const char* what : {"task errors", "operating states", "measured velocities"}) {
    EXPECT_TRUE(waitForRefusals(what)) << what;
  }
  EXPECT_TRUE(waitFor([this] { return summary().find("/stranger") != std::string::npos; })) << summary();
  EXPECT_EQ(said("task errors: publishers"), "2");
  EXPECT_EQ(cart_.state().state, ControllerState::SERVO) << cart_.state().reason;
  for (const ScopeVelocity& command : cart_.nextCommands(50)) EXPECT_GT(command.pan, 0.0);

  // Its switch says "pressed" for ever: that lets nobody move.
  cart_.strike([](Feed& feed) { feed.pressed = false; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::ARMED)) << cart_.state().reason;
  for (const ScopeVelocity& command : cart_.nextCommands(50)) EXPECT_TRUE(isZero(command));
  cart_.strike([](Feed& feed) { feed.pressed = true; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO));
  cart_.set([](Feed& feed) { feed.dead_man = false; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::ARMED)) << cart_.state().reason;
  cart_.strike([](Feed& feed) { feed.dead_man = true; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO));

  // Its task errors are no way out of a hold.
  cart_.strike([](Feed& feed) { feed.message.valid = false; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::HOLD)) << cart_.state().reason;
  for (const ScopeVelocity& command : cart_.nextCommands(50)) EXPECT_TRUE(isZero(command));
  EXPECT_EQ(cart_.state().state, ControllerState::HOLD);
  cart_.strike([](Feed& feed) { feed.message.valid = true; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO));

  // That it calls the robot enabled hides no disable.
  cart_.strike([](Feed& feed) { feed.robot_state = "DISABLED"; });
  ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << cart_.state().reason;
  for (const ScopeVelocity& command : cart_.nextCommands(50)) EXPECT_TRUE(isZero(command));
}

TEST_F(ControllerInputs, AFloodDoesNotPushTheOwnerOut) {
  engageAndMove();
  const auto other = stranger("flooder", 2000.0);
  ASSERT_TRUE(waitForRefusals("task errors"));
  for (const ScopeVelocity& command : cart_.nextCommands(50)) EXPECT_GE(command.pan, 0.0);
  EXPECT_TRUE(waitFor([this] { return cart_.moves(); })) << cart_.state().reason;
}

TEST_F(ControllerInputs, AStrangerDoesNotDrive) {
  cart_.set([](Feed& feed) { feed.task_error = false; });
  select("MANUAL");
  ASSERT_TRUE(waitFor([] { return manual().getNumSubscribers() > 0; }));
  ASSERT_TRUE(waitFor([this] { return isSilent(); })) << manualAge();
  ASSERT_TRUE(cart_.engageWhenReady()) << cart_.answer();
  ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO)) << cart_.state().reason;
  ScopeVelocity right;
  int count = 0;
  const auto drive = [&] {
    right.pan = 0.05 + 1e-6 * ++count;
    manual().publish(right);
    return cart_.nextCommands(1).back();
  };
  // At rest first, then deflected for long enough that a command follows it on a busy machine, too.
  ASSERT_TRUE(waitFor(
      [&] {
        manual().publish(ScopeVelocity());
        cart_.nextCommands(3);
        for (int k = 0; k < 20; ++k) {
          if (drive().pan > 0.0) return true;
        }
        return false;
      },
      20.0))
      << cart_.state().state << ": " << cart_.state().reason << ", " << cart_.state().caution;
  const auto other = stranger("driver", 100.0);
  ASSERT_TRUE(waitFor(
      [&] {
        EXPECT_GE(drive().pan, 0.0);
        return std::atoi(said("manual commands: refused for their sender").c_str()) > 20;
      },
      20.0));
  for (int k = 0; k < 50; ++k) EXPECT_GE(drive().pan, 0.0);
  EXPECT_EQ(cart_.state().state, ControllerState::SERVO);
  // When the own one falls silent, nobody takes its place.
  ASSERT_TRUE(waitFor([this] { return isZero(cart_.nextCommands(1).back()); }));
  for (const ScopeVelocity& command : cart_.nextCommands(50)) EXPECT_TRUE(isZero(command));
  select("HOLD_VIEW");
}

// A driver's process dies, and is replaced by another of its name. (Of two that live, the master ends the older one.)
TEST_F(ControllerInputs, ANewConnectionOfTheOwnerHasToWait) {
  cart_.set([](Feed& feed) { feed.task_error = false; });
  select("MANUAL");
  const auto first = stranger("joy", 50.0, 0.0, true);
  // Who speaks when somebody engages is bound.
  ASSERT_TRUE(waitFor([this] { return speaks(); }, 20.0));
  ASSERT_TRUE(cart_.engageWhenReady()) << cart_.answer();
  ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO)) << cart_.state().reason;
  ASSERT_TRUE(waitFor([this] { return isDriven(); }, 20.0)) << cart_.state().caution;
  first->kill(SIGKILL);
  const auto second = stranger("joy", 50.0, -0.5, true);
  ASSERT_TRUE(cart_.waitForState(ControllerState::LOST, 20.0)) << cart_.state().reason;
  EXPECT_NE(cart_.state().reason.find("/joy, has connected anew"), std::string::npos) << cart_.state().reason;
  for (const ScopeVelocity& command : cart_.nextCommands(20)) EXPECT_TRUE(isZero(command));
  select("HOLD_VIEW");
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  const bool publish = argc > 1 && std::string(argv[1]) == "publish";
  if (!publish) testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_inputs");
  if (!publish) return RUN_ALL_TESTS();
  laparoscope_servo::Stranger().run();
  return 0;
}
