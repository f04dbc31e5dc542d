// The controller as a process: how it starts, with parameters good and bad, and how it ends.
#include <signal.h>
#include <std_msgs/Empty.h>
#include <sys/wait.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>

#include "fake_cart.h"
#include "ros/controller/controller_node.h"

namespace laparoscope_servo {
namespace {

// `rosrun laparoscope_servo controller ARGUMENTS`, which replaces itself by the node, or another program.
class Process {
 public:
  explicit Process(const std::vector<std::string>& arguments,
                   std::vector<std::string> words = {"rosrun", "laparoscope_servo", "controller"}) {
    words.insert(words.end(),
                 {"_owners/task_error:=controller_process", "_owners/operating_state:=controller_process"});
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(&word[0]);
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      execvp(argv[0], argv.data());
      _exit(127);
    }
  }
  ~Process() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  void signal(int number) const { kill(pid_, number); }

  // The exit status, or -1 when it did not end by itself in time.
  int wait(double seconds = 10.0) {
    int status = 0;
    const bool ended = waitFor([&] { return waitpid(pid_, &status, WNOHANG) == pid_; }, seconds);
    if (!ended) return -1;
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
};

// Runs the controller with bad parameters; its output and its exit status.
std::string runToEnd(const std::string& arguments, int& status) {
  std::FILE* pipe = popen(("timeout 10 rosrun laparoscope_servo controller " + arguments + " 2>&1").c_str(), "r");
  std::string output;
  char buffer[256];
  while (std::fgets(buffer, sizeof(buffer), pipe) != nullptr) output += buffer;
  status = WEXITSTATUS(pclose(pipe));
  return output;
}

TEST(ControllerProcess, ListsAllBadParametersAndRefusesToStart) {
  ros::NodeHandle node;
  node.setParam("/bad/rate", "fast");
  node.setParam("/bad/gains/pan", -0.3);
  node.setParam("/bad/gain/pan", 0.3);  // a typing error
  node.setParam("/bad/dead_zone/inverse", 1);
  node.setParam("/bad/limits/velocity/insertion", 5.0);
  node.setParam("/bad/safety/min_depth", std::vector<double>{0.1});
  node.setParam("/bad/frames/camera", "");
  node.setParam("/bad/owners/manual", "my joystick");
  node.setParam("/bad/frames/insertion_point", "/insertion_point");
  int status = 0;
  const std::string output = runToEnd("__name:=bad", status);
  EXPECT_EQ(status, 1);
  for (const char* name :
       {"rate", "gains/pan = -0.3", "gain/pan is no parameter", "dead_zone/inverse", "limits/velocity/insertion",
        "safety/min_depth", "frames/camera", "frames/insertion_point", "owners/manual"}) {
    EXPECT_NE(output.find(name), std::string::npos) << name << " is not in:\n" << output;
  }
}

TEST(ControllerProcess, StartsWithoutFurtherParameters) {
  Process process({"__name:=plain", "servo_command:=plain/servo_command", "_owners/tf:=controller_process"});
  FakeCart cart("/plain", "/plain/servo_command");
  ASSERT_TRUE(cart.waitForController());
  EXPECT_TRUE(cart.stands());
  EXPECT_TRUE(cart.engageWhenReady());
}

// Sent before the process ended, handled here a moment later.
bool endsWithZero(FakeCart& cart) {
  bool zero = false;
  waitFor(
      [&] {
        const std::vector<ScopeVelocity> commands = cart.takeCommands();
        if (!commands.empty()) zero = isZero(commands.back());
        return zero;
      },
      1.0);
  return zero;
}

class Ending : public ::testing::TestWithParam<int> {};

TEST_P(Ending, LastCommandIsZero) {
  const std::string name = "ending_" + std::to_string(GetParam());
  Process process({"__name:=" + name, "servo_command:=" + name + "/servo_command", "_owners/tf:=controller_process"});
  FakeCart cart("/" + name, "/" + name + "/servo_command");
  ASSERT_TRUE(cart.waitForController());
  ASSERT_TRUE(cart.engageWhenReady());
  ASSERT_TRUE(waitFor([&] { return cart.moves(); }));
  if (GetParam() == 0) {
    ASSERT_EQ(std::system(("rosnode kill /" + name + " > /dev/null").c_str()), 0);
  } else {
    process.signal(GetParam());
  }
  EXPECT_EQ(process.wait(), 0);
  EXPECT_TRUE(endsWithZero(cart));
}

INSTANTIATE_TEST_SUITE_P(ByEachWay, Ending, ::testing::Values(SIGINT, SIGTERM, 0 /* rosnode kill */));

TEST(ControllerProcess, AnExceptionSendsZeroAndEnds) {
  Process process({"__name:=throwing", "servo_command:=throwing/servo_command", "_owners/tf:=controller_process"},
                  {"/proc/self/exe", "throwing_node"});
  FakeCart cart("/throwing", "/throwing/servo_command");
  ASSERT_TRUE(cart.waitForController());
  ASSERT_TRUE(cart.engageWhenReady());
  ros::NodeHandle node;
  ros::Publisher trigger = node.advertise<std_msgs::Empty>("throw", 1);
  ASSERT_TRUE(waitFor([&] { return trigger.getNumSubscribers() > 0; }));
  ASSERT_TRUE(waitFor([&] { return cart.moves(); }));
  trigger.publish(std_msgs::Empty());
  EXPECT_EQ(process.wait(), 1);
  EXPECT_TRUE(endsWithZero(cart));
  EXPECT_TRUE(cart.waitForState(ControllerState::FAULT));
  EXPECT_NE(cart.state().reason.find("a fault in the program"), std::string::npos) << cart.state().reason;
}

// A machine that stood still, a debugger: nobody knows what the arm has done in between.
TEST(ControllerProcess, APauseOfTheProcessIsAFault) {
  Process process({"__name:=paused", "servo_command:=paused/servo_command", "_owners/tf:=controller_process"});
  FakeCart cart("/paused", "/paused/servo_command");
  ASSERT_TRUE(cart.waitForController());
  ASSERT_TRUE(cart.engageWhenReady());
  ASSERT_TRUE(waitFor([&] { return cart.moves(); }));
  process.signal(SIGSTOP);
  std::this_thread::sleep_for(std::chrono::milliseconds(1200));
  process.signal(SIGCONT);
  ASSERT_TRUE(cart.waitForState(ControllerState::FAULT)) << cart.state().state << ": " << cart.state().reason;
  EXPECT_NE(cart.state().reason.find("steady clock jumped"), std::string::npos) << cart.state().reason;
  EXPECT_TRUE(cart.stands());
  bool success = true;
  EXPECT_NE(cart.engage(true, success).find("disengage"), std::string::npos);
  EXPECT_FALSE(success);
  cart.engage(false, success);
  EXPECT_TRUE(cart.engageWhenReady());
  EXPECT_TRUE(waitFor([&] { return cart.moves(); }));
}

void fail(const std_msgs::Empty::ConstPtr&) {
  throw std::runtime_error("a fault in the program");
}

// The controller with a fault in it.
int runThrowingNode() {
  ros::NodeHandle node, private_node("~");
  const ros::Subscriber subscriber = node.subscribe<std_msgs::Empty>("throw", 1, &fail);
  ParameterReader reader(parametersOf(private_node), private_node.getNamespace());
  ControllerNodeConfig config = controllerNodeConfig(reader);
  resolveNames(config, node);
  ControllerNode controller(node, private_node, config);
  const int status = controller.run([] { return false; });
  ros::WallDuration(0.2).sleep();  // for what was published to leave
  return status;
}

TEST(ControllerProcess, NamesAFrameThatDoesNotExist) {
  Process process({"__name:=nowhere", "servo_command:=nowhere/servo_command", "_frames/insertion_point:=atlantis",
                   "_owners/tf:=controller_process"});
  FakeCart cart("/nowhere", "/nowhere/servo_command");
  ASSERT_TRUE(cart.waitForController());
  bool success = true;
  std::string message;
  EXPECT_TRUE(waitFor([&] {
    message = cart.engage(true, success);
    return message.find("atlantis") != std::string::npos;
  })) << message;
  EXPECT_FALSE(success);
  EXPECT_TRUE(cart.stands());
}

TEST(ControllerProcess, RefusesAStaticDepth) {
  tf2_ros::StaticTransformBroadcaster broadcaster;
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "fixed_insertion_point";
  transform.child_frame_id = "fixed_camera";
  transform.transform.translation.z = 0.1;
  transform.transform.rotation.w = 1.0;
  broadcaster.sendTransform(transform);
  Process process({"__name:=fixed", "servo_command:=fixed/servo_command",
                   "_frames/insertion_point:=fixed_insertion_point", "_frames/camera:=fixed_camera",
                   "_frames/shaft:=fixed_camera", "_owners/tf:=controller_process"});
  FakeCart cart("/fixed", "/fixed/servo_command");
  ASSERT_TRUE(cart.waitForController());
  bool success = true;
  std::string message;
  EXPECT_TRUE(waitFor([&] {
    message = cart.engage(true, success);
    return message.find("static") != std::string::npos;
  })) << message;
  EXPECT_FALSE(success);
  EXPECT_TRUE(cart.stands());
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "throwing_node") {
    ros::init(argc, argv, "controller", ros::init_options::NoSigintHandler);
    return laparoscope_servo::runThrowingNode();
  }
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_process");
  ros::NodeHandle node;  // keeps ROS up between the tests
  return RUN_ALL_TESTS();
}
