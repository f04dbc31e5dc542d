// What is wrong before the arm moves: ports, parameters, command lines, clocks. Clear errors, and nothing else dies.
#include <gtest/gtest.h>
#include <rosgraph_msgs/Clock.h>

#include <fstream>
#include <sstream>

#include "ros/common/parameters.h"
#include "system/aesop/aesop_bench.h"

namespace laparoscope_servo::test {
namespace {

bool mentions(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

std::string contents(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// Starts a second node, on another port, and waits until it has said `what`.
void expectComplaint(AesopBench& bench, const std::string& port, const std::string& what) {
  const std::string output = bench.file("output");
  XmlRpc::XmlRpcValue parameters = parametersFromYaml(AESOP_CONFIG);
  parameters["port"] = port;
  ros::param::set("/other", parameters);
  std::optional<OperatingState> state;
  ros::NodeHandle node;
  const ros::Subscriber subscriber = node.subscribe<OperatingState>(
      "other/operating_state", 1, [&](const OperatingState::ConstPtr& message) { state = *message; });
  {
    ChildProcess other(AESOP_NODE, {"__name:=other", "servo_command:=other_command"}, output);
    EXPECT_TRUE(bench.waitFor([&] { return state && mentions(state->reason, what); }))
        << port << ": " << contents(output);
    EXPECT_TRUE(state && state->state == "DISABLED");
    EXPECT_TRUE(other.isRunning()) << "it waits for the port to come";
    EXPECT_TRUE(mentions(contents(output), what)) << contents(output);
    other.kill(SIGTERM);
    EXPECT_EQ(other.exitStatus(5.0), 0);
  }
  ::unlink(output.c_str());
}

TEST(AesopStart, portsThatCannotBe) {
  AesopBench bench;
  expectComplaint(bench, bench.file("nothing"), "no such port");
  const std::string file = bench.file("file");
  std::ofstream(file) << "text";
  expectComplaint(bench, file, "no serial port");
  ::unlink(file.c_str());
  expectComplaint(bench, bench.port(), "in use");
  EXPECT_TRUE(bench.startMoving()) << "the first one is not disturbed";
}

TEST(AesopStart, wrongParametersAreAllNamedAndTheNodeDoesNotStart) {
  AesopBench bench(false);
  const std::string output = bench.file("output");
  XmlRpc::XmlRpcValue parameters = parametersFromYaml(AESOP_CONFIG);
  parameters["baud_rate"] = "fast";
  XmlRpc::XmlRpcValue plane;
  plane[0] = plane[1] = 0.5;
  parameters["insertion_point"] = plane;
  parameters["command"]["timeout"] = -1.0;
  parameters["link"]["raet"] = 40.0;
  ros::param::del("/wrong");
  ros::param::set("/wrong", parameters);
  ChildProcess node(AESOP_NODE, {"__name:=wrong"}, output);
  EXPECT_EQ(node.exitStatus(10.0), 1);
  const std::string text = contents(output);
  for (const char* what : {"/wrong/port is not set", "/wrong/baud_rate = 'fast'", "/wrong/insertion_point",
                           "timeout = -1", "/wrong/link/raet", "5 errors"}) {
    EXPECT_TRUE(mentions(text, what)) << "does not name " << what << ":\n" << text;
  }
  ::unlink(output.c_str());
}

TEST(AesopEmulator, commandLine) {
  AesopBench bench(false);
  const std::string output = bench.file("output");
  const std::string wrong = bench.file("wrong.yaml");
  const std::string link = bench.file("other");
  std::ofstream(wrong) << "emulator: {delay: late, dely: 0.1}\nemulatr: {delay: 0.1}\n";
  const std::string script = bench.file("script.yaml");
  std::ofstream(script) << "script: [{at: 1, fault: reboot}, {at: 2, fault: rust}]\n";
  struct Case {
    std::vector<std::string> arguments;
    int status;
    std::vector<std::string> says;
  };
  const Case cases[] = {
      {{"--help"}, 0, {"--link", "--control", "hangup", "--script"}},
      {{}, 1, {"--link is missing"}},
      {{"--link", link, "--speed", "9"}, 1, {"--speed"}},
      {{"--link", link, "--params", wrong}, 1, {"3 errors", "emulator/delay", "emulator/dely", "emulatr"}},
      {{"--link", link, "--script", script}, 1, {"script.yaml", "entry 2", "rust"}},
      {{"--link", link, "--script", "/no/such/file"}, 1, {"/no/such/file"}},
      {{"--link", link, "--baud", "12"}, 1, {"--baud 12"}},
      {{"--link", link, "--params", "/no/such/file"}, 1, {"/no/such/file"}},
      {{"--link", wrong}, 1, {"no symbolic link"}},
  };
  for (const Case& c : cases) {
    ChildProcess emulator(AESOP_EMULATOR, c.arguments, output);
    EXPECT_EQ(emulator.exitStatus(5.0), c.status);
    for (const std::string& what : c.says)
      EXPECT_TRUE(mentions(contents(output), what)) << what << ":\n" << contents(output);
  }
  ::unlink(output.c_str());
  ::unlink(wrong.c_str());
  ::unlink(script.c_str());
}

// Last in this file: it changes what time it is for every node that starts after it.
TEST(AesopStart, simulatedTimeThatStandsDoesNotStopTheWatchdog) {
  ros::param::set("/use_sim_time", true);
  AesopBench bench(false);
  ros::NodeHandle node;
  ros::Publisher clock = node.advertise<rosgraph_msgs::Clock>("/clock", 1);
  double simulated = 100.0;
  const auto tick = [&] {
    simulated += 0.001;
    rosgraph_msgs::Clock message;
    message.clock = ros::Time(simulated);
    clock.publish(message);
  };
  bench.startNode();
  ASSERT_TRUE(bench.waitFor([&] {
    tick();
    return clock.getNumSubscribers() > 0 && simulated > 100.3;
  }));
  EXPECT_TRUE(bench.call("enable").success);
  double sent = 0.0;
  EXPECT_TRUE(bench.waitFor([&] {
    tick();
    if (simulated - sent > 0.02) bench.send(0.05, 0.0, ros::Time(sent = simulated));
    return bench.jointsMove();
  }));
  // Clock and commands end together: no time passes for ROS, but it does for the arm.
  EXPECT_LT(bench.timeToStandStill(), 1.5);
  ros::param::set("/use_sim_time", false);
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  return laparoscope_servo::test::runBenchTests(argc, argv, "aesop_start_test");
}
