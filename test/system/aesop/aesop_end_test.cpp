// However the node ends, the arm is left standing: signals, an exception; and what must not end it: a full disk.
#include <gtest/gtest.h>
#include <std_msgs/Empty.h>

#include <stdexcept>

#include "ros/aesop/aesop_node.h"
#include "system/aesop/aesop_bench.h"

namespace laparoscope_servo::test {
namespace {

void expectDisabledAndStanding(AesopBench& bench) {
  EXPECT_EQ(bench.truth().motion().state, "DISABLED") << "by its last word, not by the time to live";
  EXPECT_LT(bench.timeToStandStill(), 1.5);
  EXPECT_EQ(bench.motionWithin(0.5), 0.0);
}

TEST(AesopEnd, signals) {
  AesopBench bench(false);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    SCOPED_TRACE(signal);
    bench.startNode();
    ASSERT_TRUE(bench.startMoving());
    bench.node().kill(signal);
    EXPECT_EQ(bench.node().exitStatus(5.0), 0);
    expectDisabledAndStanding(bench);
  }
}

// roslaunch asks with SIGINT, waits, and asks again.
TEST(AesopEnd, impatience) {
  AesopBench bench;
  ASSERT_TRUE(bench.startMoving());
  for (const int signal : {SIGINT, SIGINT, SIGTERM, SIGTERM}) bench.node().kill(signal);
  EXPECT_EQ(bench.node().exitStatus(5.0), 0);
  expectDisabledAndStanding(bench);
}

TEST(AesopEnd, anExceptionInTheLoop) {
  AesopBench bench(false);
  bench.startNode("/proc/self/exe", {"throwing_node"});
  ASSERT_TRUE(bench.startMoving());
  ros::NodeHandle node;
  ros::Publisher trigger = node.advertise<std_msgs::Empty>("throw", 1);
  ASSERT_TRUE(bench.commandUntil([&] { return trigger.getNumSubscribers() > 0; }, 0.05));
  ASSERT_TRUE(bench.jointsMove());
  trigger.publish(std_msgs::Empty());
  EXPECT_EQ(bench.node().exitStatus(5.0), 1);
  expectDisabledAndStanding(bench);
}

// Every write of a log fails with ENOSPC.
TEST(AesopEnd, aFullDiskChangesNothing) {
  AesopBench bench(false);
  bench.startNode(AESOP_NODE, {"__log:=/dev/full"}, "/dev/full");
  ASSERT_TRUE(bench.startMoving());
  bench.send(std::numeric_limits<double>::quiet_NaN(), 0.0, ros::Time::now());  // which is worth a line in the log
  EXPECT_LT(bench.timeToStandStill(), 1.5);
  EXPECT_TRUE(bench.commandUntil([&] { return bench.jointsMove(); }, 0.05)) << "it goes on as on any other disk";
  bench.node().kill(SIGTERM);
  EXPECT_EQ(bench.node().exitStatus(5.0), 0);
  expectDisabledAndStanding(bench);
}

void fail(const std_msgs::Empty::ConstPtr&) {
  throw std::runtime_error("a fault in the program");
}

// The aesop node with a fault in it.
int runThrowingNode() {
  const ros::NodeHandle private_node("~");
  ros::NodeHandle node;
  const ros::Subscriber subscriber = node.subscribe<std_msgs::Empty>("throw", 1, &fail);
  ParameterReader reader(parametersOf(private_node), private_node.getNamespace());
  try {
    AesopNode(node, private_node, readAesopParameters(reader)).run([] { return false; });
  } catch (const std::runtime_error&) {
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "throwing_node") {
    ros::init(argc, argv, "aesop");
    return laparoscope_servo::test::runThrowingNode();
  }
  return laparoscope_servo::test::runBenchTests(argc, argv, "aesop_end_test");
}
