// The node as others see it: topics, services, tf.
#include <XmlRpcClient.h>
#include <gtest/gtest.h>
#include <ros/master.h>
#include <ros/network.h>
#include <tf2_ros/transform_listener.h>

#include <cmath>
#include <limits>

#include "laparoscope_servo/aesop/driver.h"
#include "system/aesop/aesop_bench.h"

namespace laparoscope_servo::test {
namespace {

TEST(AesopNode, publishesJointsPoseAndFrames) {
  AesopBench bench;
  ASSERT_TRUE(bench.waitFor([&] { return bench.joints_ && bench.pose_ && bench.twist_ && bench.diagnostics_; }));
  ASSERT_EQ(bench.joints_->name.size(), 7u);
  EXPECT_EQ(bench.joints_->name[0], "joint_1");
  const aesop::JointVector q = bench.truth().state().q;
  for (int k = 0; k < 7; ++k) EXPECT_NEAR(bench.joints_->position[static_cast<std::size_t>(k)], q[k], 1e-6);
  EXPECT_EQ(bench.pose_->header.frame_id, "aesop_base");
  const Eigen::Vector3d p = aesop::Kinematics(aesop::KinematicsConfig()).optical(q).translation();
  EXPECT_NEAR(bench.pose_->pose.position.x, p.x(), 1e-5);
  EXPECT_NEAR(bench.pose_->pose.position.z, p.z(), 1e-5);

  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  const auto known = [&] { return buffer.canTransform("insertion_point", "laparoscope_optical", ros::Time(0)); };
  ASSERT_TRUE(bench.waitFor(known));
  const auto optical =
      buffer.lookupTransform("insertion_point", "laparoscope_optical", ros::Time(0)).transform.translation;
  EXPECT_NEAR(std::hypot(optical.x, optical.y, optical.z), 0.10, 1e-3) << "d2";
  for (const char* frame : {"link_1", "link_6", "end_effector", "scope_tip"}) {
    EXPECT_TRUE(buffer.canTransform("aesop_base", frame, ros::Time(0))) << frame;
  }
  const auto ahead = buffer.lookupTransform("end_effector", "laparoscope_optical", ros::Time(0)).transform;
  EXPECT_NEAR(ahead.translation.z, 0.30, 1e-9);
  EXPECT_NEAR(ahead.rotation.w, 1.0, 1e-9);
}

// Not when it is published: the line holds every byte back, and what has come is as old as that.
TEST(AesopNode, stampsAreOfWhenTheArmWasSo) {
  AesopBench bench;
  ASSERT_TRUE(bench.waitFor([&] { return bench.isUp(); }));
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  constexpr double kHeldBack = 0.1;  // s
  bench.truth().fault("delay", kHeldBack);
  const auto next = [&] {
    bench.joints_.reset();
    bench.twist_.reset();
    return bench.waitFor([&] { return bench.joints_ && bench.twist_; });
  };
  for (int k = 0; k < 20; ++k) ASSERT_TRUE(next());  // what was under way before
  for (int k = 0; k < 10; ++k) {
    ASSERT_TRUE(next());
    const double now = ros::Time::now().toSec();
    EXPECT_GE(now - bench.joints_->header.stamp.toSec(), kHeldBack);
    EXPECT_GE(now - bench.twist_->header.stamp.toSec(), kHeldBack);
    const auto tf = buffer.lookupTransform("aesop_base", "end_effector", ros::Time(0));
    EXPECT_GE(ros::Time::now().toSec() - tf.header.stamp.toSec(), kHeldBack);
  }
}

TEST(AesopNode, startsDisabledAndFollowsCommandsOnceEnabled) {
  AesopBench bench;
  EXPECT_TRUE(bench.stateIs("DISABLED"));
  const aesop::JointVector before = bench.truth().state().q;
  EXPECT_FALSE(bench.commandUntil([&] { return bench.jointsMove(); }, 0.05, 0.6)) << "it moved before it was enabled";
  ASSERT_TRUE(bench.enable());
  const aesop::Kinematics kinematics{aesop::KinematicsConfig()};
  const Eigen::Isometry3d start = kinematics.optical(before);
  const auto turned = [&] {
    return Eigen::Isometry3d(start.inverse() * kinematics.optical(bench.truth().state().q)).linear()(0, 2) > 0.03;
  };
  EXPECT_TRUE(bench.commandUntil(turned, 0.05)) << "a positive pan turns the axis to the right";
  EXPECT_TRUE(bench.twist_ && std::hypot(bench.twist_->twist.angular.x, bench.twist_->twist.angular.y) > 0.02);
  const std_srvs::Trigger::Response disabled = bench.call("disable");
  EXPECT_TRUE(disabled.success) << disabled.message;
  EXPECT_FALSE(bench.jointsMove());
  EXPECT_TRUE(bench.waitFor([&] { return bench.stateIs("DISABLED"); }));
}

TEST(AesopNode, anOldCommandDoesNotMoveAFreshlyEnabledArm) {
  AesopBench bench;
  const ros::Time old = ros::Time::now();
  ASSERT_TRUE(bench.enable());
  EXPECT_EQ(bench.motionWithin(0.6, [&] { bench.send(0.05, 0.0, old); }), 0.0);
  EXPECT_TRUE(bench.waitFor([&] { return bench.state_->reason.find("refused") != std::string::npos; }))
      << bench.state_->reason;
}

TEST(AesopNode, commandsThatAreNoNewsRunOut) {
  AesopBench bench;
  ASSERT_TRUE(bench.startMoving());
  const ros::Time stamp = ros::Time::now();
  bench.send(0.05, 0.0, stamp);
  const auto repeat = [&] { bench.send(0.05, 0.0, stamp); };
  EXPECT_TRUE(bench.waitFor([&] {
    repeat();
    return !bench.jointsMove();
  })) << "a command repeated with its old stamp keeps the arm moving";
  EXPECT_EQ(bench.motionWithin(0.5, repeat), 0.0);
}

TEST(AesopNode, pauseHoldsAndResumeWaitsForACommand) {
  AesopBench bench;
  EXPECT_FALSE(bench.call("pause").success) << "only an enabled arm can be paused";
  ASSERT_TRUE(bench.startMoving());
  EXPECT_TRUE(bench.call("pause").success);
  ASSERT_TRUE(bench.waitFor([&] { return bench.stateIs("PAUSED") && !bench.jointsMove(); }));
  EXPECT_FALSE(bench.commandUntil([&] { return bench.jointsMove(); }, 0.05, 0.5));
  EXPECT_TRUE(bench.call("resume").success);
  EXPECT_EQ(bench.motionWithin(0.4), 0.0);
  EXPECT_TRUE(bench.commandUntil([&] { return bench.jointsMove(); }, 0.05));
}

TEST(AesopNode, slowsAndHoldsAtTheDepthAndSaysSo) {
  AesopBench bench;
  bench.truth().hand({0.0, 0.0, 0.0, 0.09}, 0.5);
  ASSERT_TRUE(bench.waitFor([&] { return !bench.truth().motion().moving; }));
  ASSERT_TRUE(bench.enable());
  const auto deeper = [&](const std::string& reason) {
    return bench.waitFor([&] {
      bench.send(0.0, 0.02, ros::Time::now());
      return bench.state_->reason.find(reason) != std::string::npos;
    });
  };
  EXPECT_TRUE(deeper("slowed: the scope is near its greatest depth")) << bench.state_->reason;
  // Slowed like this it comes as near as it likes, and not beyond.
  const aesop::Kinematics kinematics{aesop::KinematicsConfig()};
  const auto room = [&] {
    const double lever = kinematics.leverArm(bench.truth().state().q, aesop::DriverConfig().insertion_point);
    return aesop::KinematicsConfig().depth_maximum - (aesop::KinematicsConfig().scope_length - lever);
  };
  EXPECT_TRUE(bench.waitFor([&] {
    bench.send(0.0, 0.02, ros::Time::now());
    return room() < 0.003;
  })) << room();
  EXPECT_GT(room(), 0.0);
  EXPECT_TRUE(bench.waitFor([&] {
    bench.send(0.0, -0.02, ros::Time::now());
    return room() > 0.006;
  })) << "the way back is free";
}

TEST(AesopNode, aFaultClearsToDisabled) {
  AesopBench bench;
  EXPECT_FALSE(bench.call("clear_fault").success) << "there is none";
  ASSERT_TRUE(bench.startMoving());
  bench.truth().fault("bits", aesop::kFaultMotor | 0x4000);
  ASSERT_TRUE(bench.commandUntil([&] { return bench.stateIs("FAULT"); }, 0.05));
  EXPECT_NE(bench.state_->reason.find("motor"), std::string::npos) << bench.state_->reason;
  EXPECT_NE(bench.state_->reason.find("0x4000"), std::string::npos) << bench.state_->reason;
  EXPECT_FALSE(bench.call("enable").success);
  EXPECT_FALSE(bench.call("clear_fault").success) << "its cause is still there";
  bench.truth().fault("bits", 0);
  EXPECT_TRUE(bench.stateIs("FAULT"));
  const std_srvs::Trigger::Response cleared = bench.call("clear_fault");
  EXPECT_TRUE(cleared.success) << cleared.message;
  EXPECT_TRUE(bench.waitFor([&] { return bench.stateIs("DISABLED"); }));
  EXPECT_FALSE(bench.commandUntil([&] { return bench.jointsMove(); }, 0.05, 0.5));
  EXPECT_TRUE(bench.startMoving());
}

TEST(AesopNode, disablesTheArmWhenItIsTerminated) {
  AesopBench bench;
  ASSERT_TRUE(bench.startMoving());
  bench.node().kill(SIGTERM);
  EXPECT_EQ(bench.node().exitStatus(5.0), 0);
  EXPECT_EQ(bench.truth().motion().state, "DISABLED");
  EXPECT_LT(bench.timeToStandStill(), 3.0);
}

// As `rosnode kill` does: ROS is down before the node knows.
TEST(AesopNode, disablesTheArmWhenRosShutsItDown) {
  AesopBench bench;
  ASSERT_TRUE(bench.startMoving());
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue uri;
  request[0] = ros::this_node::getName();
  request[1] = std::string("/aesop");
  ASSERT_TRUE(ros::master::execute("lookupNode", request, response, uri, false));
  std::string host;
  std::uint32_t port = 0;
  ASSERT_TRUE(ros::network::splitURI(static_cast<std::string&>(uri), host, port));
  request[1] = std::string("test");
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  client.execute("shutdown", request, response);
  EXPECT_EQ(bench.node().exitStatus(5.0), 0);
  EXPECT_EQ(bench.truth().motion().state, "DISABLED");
  EXPECT_LT(bench.timeToStandStill(), 3.0);
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  return laparoscope_servo::test::runBenchTests(argc, argv, "aesop_node_test");
}
