// The insertion point calibrated through the node's services, by hand and by its pattern, and what becomes of it.
#include <gtest/gtest.h>
#include <laparoscope_servo/ControllerState.h>
#include <laparoscope_servo/SelectTask.h>
#include <std_srvs/SetBool.h>
#include <tf2_ros/transform_listener.h>

#include <Eigen/LU>

#include "ros/aesop/insertion_point_file.h"
#include "ros/common/parameters.h"
#include "system/aesop/calibration_bench.h"

namespace laparoscope_servo::test {
namespace {

using Eigen::Vector3d;
using Request = StartCalibration::Request;

const aesop::Kinematics kKinematics{aesop::KinematicsConfig()};

class Frames {
 public:
  bool insertionPointIs(const Vector3d& expected) const {
    try {
      const auto t = buffer_.lookupTransform("aesop_base", "insertion_point", ros::Time(0)).transform.translation;
      return (Vector3d(t.x, t.y, t.z) - expected).norm() < 1e-6;
    } catch (const tf2::TransformException&) {
      return false;
    }
  }

 private:
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_{buffer_};
};

Vector3d pointOf(const CalibrationState& state) {
  return {state.point.x, state.point.y, state.point.z};
}

void expectGood(CalibrationBench& cart, const Frames& frames) {
  const CalibrationState state = *cart.state;
  const Vector3d error = pointOf(state) - cart.trueTrocar();
  EXPECT_LT(error.norm(), 1e-3);
  EXPECT_LT(state.stddev, 3e-3);
  EXPECT_LT(state.residual, 1e-4) << "the emulator's joints are measured without noise";
  const Eigen::Matrix3d covariance(state.covariance.data());
  EXPECT_LT(error.dot(covariance.inverse() * error), 9.0) << "3 standard deviations";
  EXPECT_TRUE(cart.bench.waitFor([&] { return frames.insertionPointIs(pointOf(state)); })) << "tf follows";
  const CalibratedInsertionPoint saved = loadInsertionPoint(cart.file(), kKinematics);
  EXPECT_LT((saved.point - pointOf(state)).norm(), 1e-8);
  EXPECT_EQ(saved.method, state.method);
  EXPECT_EQ(saved.poses.size(), state.poses);
  EXPECT_EQ(saved.date.substr(0, 13), utcDate().substr(0, 13));
  ::testing::Test::RecordProperty("error_" + state.method + "_m", std::to_string(error.norm()));
  ROS_INFO_STREAM(state.method << ": error " << error.norm() << " m, stated " << state.stddev << " m, " << state.poses
                               << " poses");
}

TEST(AesopCalibration, ByHandAndLoadedByANewNode) {
  CalibrationBench cart;
  const Frames frames;
  ASSERT_TRUE(cart.waitForState(CalibrationState::IDLE));
  ASSERT_TRUE(cart.bench.waitFor([&] { return frames.insertionPointIs(believedTrocar()); }));
  EXPECT_FALSE(cart.finish().success);
  EXPECT_FALSE(cart.cancel().success);
  EXPECT_NE(cart.start("FOOT").message.find("'FOOT', expected HAND or PATTERN"), std::string::npos);
  EXPECT_NE(cart.start(Request::PATTERN).message.find("has to be ENABLED"), std::string::npos);

  ASSERT_TRUE(cart.start(Request::HAND).success);
  cart.hand(0.03, 0.0);
  const std_srvs::Trigger::Response early = cart.finish();
  EXPECT_FALSE(early.success);
  EXPECT_NE(early.message.find("expected at least 30"), std::string::npos) << early.message;
  EXPECT_NE(early.message.find("the shaft has turned by 0.0"), std::string::npos) << early.message;
  cart.hand(-0.03, 0.0);
  cart.swing(0.14);
  const std_srvs::Trigger::Response done = cart.finish();
  ASSERT_TRUE(done.success) << done.message;
  ASSERT_TRUE(cart.waitForState(CalibrationState::DONE));
  expectGood(cart, frames);
  EXPECT_TRUE(cart.bench.stateIs("DISABLED"));
  ASSERT_TRUE(cart.bench.startMoving()) << "about the new point";

  const Vector3d calibrated = pointOf(*cart.state);
  cart.restartNode("");
  ASSERT_TRUE(cart.bench.waitFor([&] { return frames.insertionPointIs(believedTrocar()); })) << "not loaded unasked";
  cart.restartNode(cart.file());
  EXPECT_TRUE(cart.bench.waitFor([&] { return frames.insertionPointIs(calibrated); }));
  const auto told = [&] {
    for (const auto& value :
         cart.bench.diagnostics_ ? cart.bench.diagnostics_->values : decltype(cart.bench.diagnostics_->values)()) {
      if (value.key == "insertion point" && value.value.find("by HAND") != std::string::npos) return true;
    }
    return false;
  };
  EXPECT_TRUE(cart.bench.waitFor(told)) << "diagnostics name the file";

  cart.bench.node().kill(SIGTERM);
  cart.bench.node().exitStatus(5.0);
  XmlRpc::XmlRpcValue parameters = parametersFromYaml(AESOP_CONFIG);
  parameters["port"] = cart.bench.port();
  parameters["insertion_point_file"] = cart.file() + ".absent";
  ros::param::set("/aesop", parameters);
  EXPECT_EQ(ChildProcess(AESOP_NODE, {"__name:=aesop"}).exitStatus(5.0), 1) << "a file that is named has to be there";
}

TEST(AesopCalibration, ByPattern) {
  CalibrationBench cart;
  const Frames frames;
  ASSERT_TRUE(cart.bench.enable());
  EXPECT_NE(cart.start(Request::HAND).message.find("has to be DISABLED"), std::string::npos);
  const StartCalibration::Response started = cart.start(Request::PATTERN);
  ASSERT_TRUE(started.success) << started.message;
  EXPECT_NE(cart.finish().message.find("ends by itself"), std::string::npos);
  ASSERT_TRUE(cart.waitForState(CalibrationState::DONE, 30.0)) << cart.state->message;
  EXPECT_TRUE(cart.bench.waitFor([&] { return cart.bench.stateIs("DISABLED"); }));
  EXPECT_FALSE(cart.bench.jointsMove());
  expectGood(cart, frames);
  EXPECT_TRUE(cart.bench.startMoving());
}

// The arm has to be disabled for it, which ends the engagement: a jump of d2 finds nobody who would follow it.
TEST(AesopCalibration, AControllerThatWasEngagedIsLostAndNothingMoves) {
  CalibrationBench cart;
  XmlRpc::XmlRpcValue parameters = parametersFromYaml(std::string(LAPAROSCOPE_SERVO_CONFIG) + "/controller.yaml");
  parameters["safety"]["robot_required"] = true;
  parameters["safety"]["resume_time"] = 10.0;
  ros::param::set("/controller", parameters);
  ChildProcess controller(CONTROLLER, {"__name:=controller", "operating_state:=/aesop/operating_state"});
  ros::NodeHandle node;
  std::optional<ControllerState> state;
  const ros::Subscriber subscriber = node.subscribe<ControllerState>(
      "controller/state", 10, [&](const ControllerState::ConstPtr& message) { state = *message; });
  ASSERT_TRUE(cart.bench.enable());
  SelectTask task;
  task.request.task = SelectTask::Request::MANUAL;
  ASSERT_TRUE(ros::service::waitForService("controller/select_task", 10000));
  ASSERT_TRUE(ros::service::call("controller/select_task", task));
  const auto engaged = [] {
    std_srvs::SetBool engage;
    engage.request.data = 1;
    return ros::service::call("controller/engage", engage) && engage.response.success;
  };
  ASSERT_TRUE(cart.bench.waitFor(engaged));
  ASSERT_TRUE(cart.bench.waitFor([&] { return state && state->state == ControllerState::SERVO; }));
  ASSERT_TRUE(cart.bench.call("disable").success);
  ASSERT_TRUE(cart.bench.waitFor([&] { return state->state == ControllerState::LOST; }));
  ASSERT_TRUE(cart.start(Request::HAND).success);
  cart.swing(0.14);
  ASSERT_EQ(state->state, ControllerState::LOST) << state->reason;
  const aesop::JointVector before = cart.bench.truth().state().q;
  ASSERT_TRUE(cart.finish().success);
  EXPECT_NE(state->reason.find("engage again"), std::string::npos) << state->reason;
  EXPECT_TRUE(cart.bench.waitFor([&] { return cart.bench.enable(); })) << "the new point waits until the arm stands";
  EXPECT_EQ(cart.bench.motionWithin(0.5), 0.0);
  EXPECT_EQ(state->state, ControllerState::LOST) << state->reason;
  EXPECT_EQ(cart.bench.truth().state().q, before);
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "aesop_calibration_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
