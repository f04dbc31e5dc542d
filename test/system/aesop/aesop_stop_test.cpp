// From each cause to joints that stand, on a real pty with real processes. AESOP_STOP_RUNS repeats each for the record;
// the bound that is asserted is far above what is measured, but below any harm.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <limits>

#include "system/aesop/aesop_bench.h"

namespace laparoscope_servo::test {
namespace {

constexpr double kPan = 0.05;         // rad/s
constexpr double kLongestStop = 1.5;  // s

int runs() {
  const char* text = std::getenv("AESOP_STOP_RUNS");
  return text == nullptr ? 1 : std::max(1, std::atoi(text));
}

void report(const std::string& cause, std::vector<double> times) {
  std::sort(times.begin(), times.end());
  std::cout << "time to stand still, " << cause << ": median " << times[times.size() / 2] << " s, worst "
            << times.back() << " s, " << times.size() << " runs" << std::endl;
  EXPECT_LT(times.back(), kLongestStop) << cause;
}

// Turns the other way round in every run, so that the arm stays in the middle of its range.
double direction(int run) {
  return run % 2 == 0 ? kPan : -kPan;
}

using Step = std::function<void(int run)>;

// `cause` befalls the moving arm; what follows leaves things as they were before.
void measure(AesopBench& bench, const std::string& name, const Step& cause, const Step& afterwards) {
  std::vector<double> times;
  for (int run = 0; run < runs(); ++run) {
    ASSERT_TRUE(bench.waitFor([&] { return bench.isUp(); }));
    ASSERT_TRUE(bench.enable());
    ASSERT_TRUE(bench.commandUntil([&] { return bench.jointsMove(); }, direction(run)));
    cause(run);
    times.push_back(bench.timeToStandStill());
    afterwards(run);
    if (testing::Test::HasFatalFailure()) return;
  }
  report(name, times);
}

TEST(AesopStop, controllerKilled) {
  AesopBench bench(false);
  bench.master_ = "/command_publisher";
  bench.startNode();
  std::vector<double> times;
  for (int run = 0; run < runs(); ++run) {
    ASSERT_TRUE(bench.enable());
    const auto controller = bench.publisher("command_publisher", direction(run));
    ASSERT_TRUE(bench.waitFor([&] { return bench.jointsMove(); }, 10.0));
    bench.waitFor([] { return false; }, 0.5);
    controller->kill(SIGKILL);
    times.push_back(bench.timeToStandStill());
    EXPECT_EQ(bench.motionWithin(0.5), 0.0);
    EXPECT_TRUE(bench.waitFor([&] { return bench.state_->reason.find("run out") != std::string::npos; }))
        << bench.state_->reason;
    EXPECT_TRUE(bench.call("disable").success);
  }
  report("controller killed", times);
}

TEST(AesopStop, nodeKilled) {
  AesopBench bench(false);
  std::vector<double> times;
  for (int run = 0; run < runs(); ++run) {
    bench.startNode();
    ASSERT_TRUE(bench.enable());
    ASSERT_TRUE(bench.commandUntil([&] { return bench.jointsMove(); }, direction(run)));
    bench.commandUntil([] { return false; }, direction(run), 0.3);
    bench.node().kill(SIGKILL);
    times.push_back(bench.timeToStandStill());
    EXPECT_EQ(bench.motionWithin(0.5), 0.0);
  }
  report("aesop node killed (SIGKILL)", times);
}

TEST(AesopStop, nodeStopped) {
  AesopBench bench;
  measure(
      bench, "aesop node stopped (SIGSTOP)", [&](int) { bench.node().kill(SIGSTOP); },
      [&](int) {
        EXPECT_EQ(bench.motionWithin(0.5), 0.0);
        bench.node().kill(SIGCONT);
        EXPECT_EQ(bench.motionWithin(0.5, [&] { bench.send(0.0, 0.0, ros::Time::now()); }), 0.0)
            << "old commands, after it woke up";
        EXPECT_TRUE(bench.waitFor([&] { return bench.call("disable").success; }));
      });
}

TEST(AesopStop, lineCut) {
  AesopBench bench;
  measure(
      bench, "line cut", [&](int) { bench.truth().fault("hangup"); },
      [&](int) {
        ASSERT_TRUE(bench.waitFor([&] { return bench.stateIs("DISABLED"); }));
        bench.truth().fault("return");
      });
}

TEST(AesopStop, commandNotFinite) {
  using Limits = std::numeric_limits<double>;
  AesopBench bench;
  measure(
      bench, "command not finite", [&](int) { bench.send(Limits::quiet_NaN(), 0.0, ros::Time::now()); },
      [&](int) {
        EXPECT_TRUE(bench.waitFor([&] { return bench.state_->reason.find("not finite") != std::string::npos; }))
            << bench.state_->reason;
        EXPECT_EQ(bench.motionWithin(0.3, [&] { bench.send(0.0, Limits::infinity(), ros::Time::now()); }), 0.0);
        EXPECT_TRUE(bench.call("disable").success);
      });
}

// A publisher that goes on, but with the stamp of long ago: a recording played again, a filter that hangs.
TEST(AesopStop, commandsWithAnOldStamp) {
  AesopBench bench;
  std::vector<double> times;
  for (int run = 0; run < runs(); ++run) {
    ASSERT_TRUE(bench.enable());
    ASSERT_TRUE(bench.commandUntil([&] { return bench.jointsMove(); }, direction(run)));
    const ros::Time stamp = ros::Time::now();
    bench.send(direction(run), 0.0, stamp);
    const double start = steadyNow();
    double next = start;
    const auto repeat = [&] {
      if (steadyNow() < next) return;
      next += 0.02;
      bench.send(direction(run), 0.0, stamp);
    };
    ASSERT_TRUE(bench.waitFor([&] {
      repeat();
      return !bench.jointsMove();
    }));
    times.push_back(steadyNow() - start);
    EXPECT_EQ(bench.motionWithin(0.3, repeat), 0.0);
    EXPECT_TRUE(bench.waitFor([&] { return bench.state_->reason.find("not newer") != std::string::npos; }))
        << bench.state_->reason;
    EXPECT_TRUE(bench.call("disable").success);
  }
  report("commands with an old stamp", times);
}

TEST(AesopStop, everyByteCorrupted) {
  AesopBench bench;
  std::vector<double> times;
  for (int run = 0; run < runs(); ++run) {
    ASSERT_TRUE(bench.waitFor([&] { return bench.isUp(); }));
    ASSERT_TRUE(bench.enable());
    ASSERT_TRUE(bench.commandUntil([&] { return bench.jointsMove(); }, direction(run)));
    bench.truth().fault("corrupt", 1.0);
    const double start = steadyNow();
    ASSERT_TRUE(bench.commandUntil([&] { return !bench.jointsMove(); }, direction(run)));
    times.push_back(steadyNow() - start);
    EXPECT_TRUE(bench.commandUntil([&] { return bench.stateIs("DISABLED"); }, direction(run)));
    bench.truth().fault("none");
    EXPECT_EQ(bench.motionWithin(0.4, [&] { bench.send(direction(run), 0.0, ros::Time::now()); }), 0.0);
  }
  report("every byte corrupted", times);
}

TEST(AesopStop, faultOfTheRobot) {
  AesopBench bench;
  measure(
      bench, "fault of the robot", [&](int) { bench.truth().fault("bits", 1); },
      [&](int) {
        ASSERT_TRUE(bench.waitFor([&] { return bench.stateIs("FAULT"); }));
        bench.truth().fault("bits", 0);
        ASSERT_TRUE(bench.call("clear_fault").success);
      });
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  return laparoscope_servo::test::runBenchTests(argc, argv, "aesop_stop_test");
}
