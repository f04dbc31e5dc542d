// Lines that are bad or go away while the arm moves: the node says so, the arm stands, and only enable moves it again.
#include <gtest/gtest.h>

#include "system/aesop/aesop_bench.h"

namespace laparoscope_servo::test {
namespace {

bool mentions(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

TEST(AesopLine, portTakenAwayWhileMoving) {
  AesopBench bench;
  ASSERT_TRUE(bench.startMoving());
  bench.truth().fault("hangup");
  ASSERT_TRUE(bench.commandUntil([&] { return bench.stateIs("DISABLED"); }, 0.05));
  EXPECT_TRUE(mentions(bench.state_->reason, "the line has gone") || mentions(bench.state_->reason, "no such port"))
      << bench.state_->reason;
  ASSERT_TRUE(bench.commandUntil([&] { return !bench.jointsMove(); }, 0.05));
  EXPECT_FALSE(bench.call("enable").success);
  EXPECT_TRUE(bench.node().isRunning());

  bench.truth().fault("return");
  const auto command = [&] { bench.send(0.05, 0.0, ros::Time::now()); };
  ASSERT_TRUE(bench.commandUntil([&] { return bench.isUp(); }, 0.05)) << "it does not come back by itself";
  EXPECT_EQ(bench.motionWithin(1.0, command), 0.0) << "it moved before it was enabled again";
  EXPECT_TRUE(bench.stateIs("DISABLED"));
  EXPECT_TRUE(bench.startMoving());
}

TEST(AesopLine, badLines) {
  AesopBench bench;
  const std::pair<const char*, double> faults[] = {
      {"drop", 0.002}, {"corrupt", 0.002}, {"double", 0.002}, {"delay", 0.05}};
  for (const auto& [fault, value] : faults) {
    SCOPED_TRACE(fault);
    bench.truth().fault(fault, value);
    ASSERT_TRUE(bench.waitFor([&] { return bench.stateIs("ENABLED") || bench.call("enable").success; }));
    EXPECT_TRUE(bench.commandUntil([&] { return bench.jointsMove(); }, 0.05))
        << "a little damage does not stop it for good";
    double fastest = 0.0;
    bench.commandUntil(
        [&] {
          fastest = std::max(fastest, bench.truth().motion().qdot.head<4>().lpNorm<Eigen::Infinity>());
          return false;
        },
        0.05, 0.5);
    EXPECT_LT(fastest, 0.06) << "a damaged frame was taken for a command";
    EXPECT_TRUE(bench.waitFor([&] { return !bench.jointsMove(); }));
    bench.truth().fault("none");
  }
  ASSERT_TRUE(bench.waitFor([&] { return bench.diagnostics_.has_value(); }));
  EXPECT_TRUE(bench.node().isRunning());
}

TEST(AesopLine, controllerThatRestartsOrDiesIsNotMovedAgain) {
  AesopBench bench;
  ASSERT_TRUE(bench.startMoving());
  bench.truth().fault("reboot");
  ASSERT_TRUE(bench.commandUntil([&] { return bench.stateIs("DISABLED"); }, 0.05));
  EXPECT_EQ(bench.motionWithin(0.6, [&] { bench.send(0.05, 0.0, ros::Time::now()); }), 0.0);
  ASSERT_TRUE(bench.startMoving());
  bench.emulator().kill(SIGSTOP);
  ASSERT_TRUE(bench.commandUntil([&] { return bench.stateIs("DISABLED"); }, 0.05));
  EXPECT_TRUE(mentions(bench.state_->reason, "no status")) << bench.state_->reason;
  bench.emulator().kill(SIGCONT);
  ASSERT_TRUE(bench.commandUntil([&] { return bench.isUp() && !bench.jointsMove(); }, 0.05));
  EXPECT_EQ(bench.motionWithin(0.6, [&] { bench.send(0.05, 0.0, ros::Time::now()); }), 0.0);
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  return laparoscope_servo::test::runBenchTests(argc, argv, "aesop_line_test");
}
