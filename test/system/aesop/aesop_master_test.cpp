// One master of the arm: what others command moves nothing, stops nothing, and is said.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "system/aesop/aesop_bench.h"

namespace laparoscope_servo::test {
namespace {

constexpr double kPan = 0.05;  // rad/s

bool mentions(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

// Of joint 2, which a pan turns; rad/s.
double jointSpeed(AesopBench& bench) {
  return bench.truth().motion().qdot[1];
}

TEST(AesopMaster, aStrangerMovesNothing) {
  AesopBench bench;
  ASSERT_TRUE(bench.enable());
  const auto stranger = bench.publisher("stranger", kPan);
  ASSERT_TRUE(bench.waitFor([&] { return mentions(bench.state_->reason, "/stranger"); }, 10.0)) << bench.state_->reason;
  EXPECT_EQ(bench.motionWithin(1.0), 0.0);
  EXPECT_TRUE(bench.stateIs("ENABLED")) << "a stranger cannot take the arm away from its master";
  EXPECT_TRUE(bench.waitFor([&] {
    return bench.diagnostics_ && bench.diagnostics_->level == diagnostic_msgs::DiagnosticStatus::WARN &&
           mentions(bench.diagnostics_->message, "/stranger");
  })) << (bench.diagnostics_ ? bench.diagnostics_->message : "");
}

TEST(AesopMaster, commandsOfTwoAreNeverMixed) {
  AesopBench bench;
  ASSERT_TRUE(bench.startMoving());
  const double direction = jointSpeed(bench) > 0.0 ? 1.0 : -1.0;
  const auto stranger = bench.publisher("stranger", -2.0 * kPan);
  ASSERT_TRUE(bench.commandUntil([&] { return mentions(bench.state_->reason, "/stranger"); }, kPan, 10.0));
  double slowest = std::numeric_limits<double>::infinity();
  bench.commandUntil(
      [&] {
        slowest = std::min(slowest, direction * jointSpeed(bench));
        return false;
      },
      kPan, 1.0);
  EXPECT_GT(slowest, 0.0) << "the master's command goes on as it was";
  EXPECT_LT(bench.timeToStandStill(), 1.5) << "the stranger kept the arm moving when its master fell silent";
}

// What is not a number stops the arm when the master sends it, and many commands displace one another.
TEST(AesopMaster, aFloodOfNonsenseDoesNotStopTheMaster) {
  AesopBench bench;
  ASSERT_TRUE(bench.startMoving());
  const auto stranger = bench.publisher("stranger", std::numeric_limits<double>::quiet_NaN(), 2000.0);
  ASSERT_TRUE(bench.commandUntil([&] { return mentions(bench.state_->reason, "/stranger"); }, kPan, 10.0));
  double slowest = std::numeric_limits<double>::infinity();
  bench.commandUntil(
      [&] {
        slowest = std::min(slowest, std::abs(jointSpeed(bench)));
        return false;
      },
      kPan, 1.0);
  EXPECT_GT(slowest, 0.0);
}

// ROS ends the older of two nodes of one name; what the newer one commands is held until somebody resumes.
TEST(AesopMaster, aSecondProcessOfTheMastersNameHasToWait) {
  AesopBench bench(false);
  bench.master_ = "/command_publisher";
  bench.startNode();
  ASSERT_TRUE(bench.enable());
  const auto first = bench.publisher("command_publisher", kPan);
  ASSERT_TRUE(bench.waitFor([&] { return bench.jointsMove(); }, 10.0));
  const double direction = jointSpeed(bench) > 0.0 ? 1.0 : -1.0;
  const auto second = bench.publisher("command_publisher", -kPan);
  double backwards = 0.0;
  ASSERT_TRUE(bench.waitFor(
      [&] {
        backwards = std::max(backwards, -direction * jointSpeed(bench));
        return bench.stateIs("PAUSED");
      },
      10.0));
  EXPECT_EQ(backwards, 0.0);
  EXPECT_TRUE(mentions(bench.state_->reason, "connected anew")) << bench.state_->reason;
  EXPECT_LT(bench.timeToStandStill(), 1.5);
  EXPECT_EQ(bench.motionWithin(0.6), 0.0);
  EXPECT_TRUE(bench.call("resume").success);
  EXPECT_TRUE(bench.waitFor([&] { return direction * jointSpeed(bench) < 0.0; }));
}

// Who has missed a disable knows of it by the count.
TEST(AesopMaster, countsHowOftenTheArmWasEnabled) {
  AesopBench bench;
  EXPECT_EQ(bench.state_->enables, 0u);
  ASSERT_TRUE(bench.enable());
  EXPECT_EQ(bench.state_->enables, 1u);
  EXPECT_TRUE(bench.call("pause").success);
  ASSERT_TRUE(bench.waitFor([&] { return bench.stateIs("PAUSED"); }));
  EXPECT_TRUE(bench.call("resume").success);
  ASSERT_TRUE(bench.waitFor([&] { return bench.stateIs("ENABLED"); }));
  EXPECT_EQ(bench.state_->enables, 1u);
  for (std::uint32_t count = 2; count < 5; ++count) {
    EXPECT_TRUE(bench.call("disable").success);
    ASSERT_TRUE(bench.enable());
    EXPECT_TRUE(bench.waitFor([&] { return bench.state_->enables == count; })) << bench.state_->enables;
  }
}

TEST(AesopMaster, onlyNamedNodesMayEnable) {
  AesopBench bench(false);
  bench.service_callers_ = {"/theatre"};
  bench.startNode();
  for (const char* service : {"enable", "resume", "clear_fault", "calibrate_insertion_point/finish"}) {
    const std_srvs::Trigger::Response refused = bench.call(service);
    EXPECT_FALSE(refused.success) << service;
    EXPECT_TRUE(mentions(refused.message, ros::this_node::getName())) << refused.message;
    EXPECT_TRUE(mentions(refused.message, "service_callers")) << refused.message;
  }
  EXPECT_TRUE(bench.stateIs("DISABLED"));
  EXPECT_TRUE(bench.call("disable").success) << "everybody may stop the arm";

  bench.node().kill(SIGTERM);
  EXPECT_EQ(bench.node().exitStatus(5.0), 0);
  bench.service_callers_ = {"theatre", ros::this_node::getName()};
  bench.startNode();
  ASSERT_TRUE(bench.enable());
  EXPECT_TRUE(bench.call("pause").success);
  EXPECT_TRUE(bench.call("resume").success);
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  return laparoscope_servo::test::runBenchTests(argc, argv, "aesop_master_test");
}
