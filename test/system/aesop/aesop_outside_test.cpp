// What stops the arm from outside of ROS and of its services: a topic that anybody may publish, a signal, a stop line;
// and what must not stop it: a terminal that nobody reads, a flood of commands.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <std_msgs/Empty.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "system/aesop/aesop_bench.h"

namespace laparoscope_servo::test {
namespace {

constexpr double kPan = 0.05;  // rad/s

bool mentions(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

void expectStopped(AesopBench& bench, const std::string& why) {
  ASSERT_TRUE(bench.commandUntil([&] { return bench.stateIs("DISABLED") && !bench.jointsMove(); }, kPan));
  EXPECT_TRUE(mentions(bench.state_->reason, why)) << bench.state_->reason;
  EXPECT_EQ(bench.motionWithin(0.4, [&] { bench.send(kPan, 0.0, ros::Time::now()); }), 0.0);
}

TEST(AesopOutside, aTopicAndASignalStopIt) {
  AesopBench bench;
  ros::NodeHandle node;
  ros::Publisher stop = node.advertise<std_msgs::Empty>("aesop/stop", 1);
  ASSERT_TRUE(bench.waitFor([&] { return stop.getNumSubscribers() > 0; }));
  ASSERT_TRUE(bench.startMoving());
  stop.publish(std_msgs::Empty());
  expectStopped(bench, "stopped by " + ros::this_node::getName());
  EXPECT_TRUE(bench.waitFor([&] {
    return bench.diagnostics_ && bench.diagnostics_->level == diagnostic_msgs::DiagnosticStatus::WARN &&
           mentions(bench.diagnostics_->message, "stopped by");
  })) << "diagnostics warn of it";
  ASSERT_TRUE(bench.startMoving()) << "it is enabled as ever";
  bench.node().kill(SIGUSR1);
  expectStopped(bench, "SIGUSR1");
  ASSERT_TRUE(bench.startMoving()) << "the node goes on";
}

TEST(AesopOutside, aFloodOfStopsIsOneStop) {
  AesopBench bench;
  ros::NodeHandle node;
  ros::Publisher stop = node.advertise<std_msgs::Empty>("aesop/stop", 1);
  ASSERT_TRUE(bench.waitFor([&] { return stop.getNumSubscribers() > 0; }));
  ASSERT_TRUE(bench.startMoving());
  EXPECT_TRUE(bench.waitFor([&] {
    stop.publish(std_msgs::Empty());
    return bench.stateIs("DISABLED") && !bench.state_->is_busy;
  })) << "confirmed while they go on";
}

TEST(AesopOutside, theStopLineStopsAndKeepsFromEnabling) {
  AesopBench bench(false);
  const std::string line = bench.file("line");
  const auto set = [&](const char* level) { std::ofstream(line) << level; };
  XmlRpc::XmlRpcValue overlay;
  overlay["stop_line"]["path"] = line;
  overlay["stop_line"]["patience"] = 5.0;  // a busy machine is late
  bench.setParameters(overlay);
  bench.startNode();
  std_srvs::Trigger::Response refused = bench.call("enable");
  EXPECT_FALSE(refused.success) << "there is no such file yet";
  EXPECT_TRUE(mentions(refused.message, "cannot be read")) << refused.message;
  set("1\n");
  ASSERT_TRUE(bench.waitFor([&] { return bench.call("enable").success; }));
  ASSERT_TRUE(bench.commandUntil([&] { return bench.jointsMove(); }, kPan));
  set("0\n");
  expectStopped(bench, "says stop");
  refused = bench.call("enable");
  EXPECT_FALSE(refused.success);
  EXPECT_TRUE(mentions(refused.message, "says stop")) << refused.message;
  set("1\n");
  EXPECT_EQ(bench.motionWithin(0.4, [&] { bench.send(kPan, 0.0, ros::Time::now()); }), 0.0)
      << "it does not go on by itself";
  ASSERT_TRUE(bench.waitFor([&] { return bench.call("enable").success; }));
  ASSERT_TRUE(bench.commandUntil([&] { return bench.jointsMove(); }, kPan));
  ::unlink(line.c_str());
  expectStopped(bench, "cannot be read");
}

// Each call of a service is a line of the log; together they are far more than the pipe holds.
TEST(AesopOutside, aTerminalThatNobodyReadsHoldsNothingUp) {
  AesopBench bench(false);
  XmlRpc::XmlRpcValue overlay;
  overlay["link"]["status_timeout"] = 4.0;  // a busy machine is late, one that waits for a reader never comes
  bench.setParameters(overlay);
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  ASSERT_GT(::fcntl(ends[1], F_SETPIPE_SZ, 4096), 0);
  bench.startNode(AESOP_NODE, {}, "/proc/self/fd/" + std::to_string(ends[1]));
  ASSERT_TRUE(bench.startMoving());
  for (int k = 0; k < 200; ++k) {
    ASSERT_FALSE(bench.call("resume").success);  // it is not paused
    bench.send(kPan, 0.0, ros::Time::now());
  }
  EXPECT_TRUE(bench.commandUntil([&] { return bench.jointsMove(); }, kPan));
  EXPECT_TRUE(bench.stateIs("ENABLED")) << bench.state_->reason;
  bench.node().kill(SIGTERM);
  EXPECT_EQ(bench.node().exitStatus(10.0), 0);
  EXPECT_EQ(bench.truth().motion().state, "DISABLED");
  for (const int end : ends) ::close(end);
}

TEST(AesopOutside, aFloodOfItsMastersCommandsIsTheNewestOne) {
  AesopBench bench(false);
  bench.master_ = "/flood";
  bench.startNode();
  ASSERT_TRUE(bench.enable());
  const auto flood = bench.publisher("flood", kPan, 10000.0);
  ASSERT_TRUE(bench.waitFor([&] { return bench.jointsMove(); }, 10.0));
  EXPECT_LT(bench.motionWithin(1.0), 0.5);
  EXPECT_TRUE(bench.stateIs("ENABLED")) << bench.state_->reason;
  flood->kill(SIGKILL);
  EXPECT_LT(bench.timeToStandStill(), 2.5) << "what had been sent was not kept";
  EXPECT_EQ(bench.motionWithin(0.4), 0.0);
}

// What is refused is refused for good: nothing of it counts later.
TEST(AesopOutside, commandsThatAreNoneMoveNothingAndBlockNothing) {
  AesopBench bench;
  ASSERT_TRUE(bench.enable());
  const double infinity = std::numeric_limits<double>::infinity();
  int k = 0;
  const auto nonsense = [&] {
    const ros::Time now = ros::Time::now();
    switch (++k % 6) {
      case 0:
        return bench.send(kPan, 0.0, now + ros::Duration(0.3));
      case 1:
        return bench.send(kPan, 0.0, now + ros::Duration(3600.0));
      case 2:
        return bench.send(kPan, 0.0, now - ros::Duration(2.0));
      case 3:
        return bench.send(kPan, 0.0, ros::Time());
      case 4:
        return bench.send(std::nan(""), 0.0, now);
      default:
        return bench.send(0.0, -infinity, now);
    }
  };
  EXPECT_EQ(bench.motionWithin(1.0, nonsense), 0.0);
  EXPECT_TRUE(bench.stateIs("ENABLED"));
  EXPECT_TRUE(bench.commandUntil([&] { return bench.jointsMove(); }, kPan)) << bench.state_->reason;
  // As fast as its limits allow, and no faster.
  bench.commandUntil([] { return false; }, 1e300, 0.5);
  EXPECT_LE(bench.truth().motion().qdot.tail<6>().cwiseAbs().maxCoeff(), 0.5);
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  return laparoscope_servo::test::runBenchTests(argc, argv, "aesop_outside_test");
}
