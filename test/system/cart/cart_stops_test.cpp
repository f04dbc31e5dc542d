// Whichever process of the loop dies while the arm moves, the arm stands.
#include <gtest/gtest.h>
#include <std_srvs/SetBool.h>

#include <functional>
#include <memory>

#include "laparoscope_servo/ControllerState.h"
#include "laparoscope_servo/Homography.h"
#include "laparoscope_servo/SelectRoi.h"
#include "ros/common/parameters.h"
#include "system/aesop/aesop_bench.h"

namespace laparoscope_servo::test {
namespace {

constexpr double kStandStill = 2.0;  // s: time-outs and the arm's delay are shorter than that together

std::string config(const std::string& name) {
  return std::string(LAPAROSCOPE_SERVO_CONFIG) + "/" + name;
}

class CartStops : public testing::Test {
 protected:
  // The cart as in demo.launch, engaged, with an error that keeps it moving for seconds.
  void SetUp() override {
    XmlRpc::XmlRpcValue camera = parametersFromYaml(config("simulation.yaml"));
    camera["tissue"]["texture_side"] = 1200;
    camera["control"] = bench_.file("control");
    ros::param::set("/simulated_camera", camera);
    ros::param::set("/tracker", parametersFromYaml(config("tracker.yaml")));
    ros::param::set("/controller", parametersFromYaml(config("controller.yaml")));
    ros::param::set("/controller/safety/robot_required", true);
    bench_.master_ = "/controller";
    bench_.startNode();
    camera_ = start(SIMULATED_CAMERA, {"__name:=simulated_camera"});
    tracker_ = start(TRACKER, {"__name:=tracker", "image:=image_raw"});
    controller_ = start(
        CONTROLLER, {"__name:=controller", "task_error:=tracker/task_error", "operating_state:=aesop/operating_state"});
    homography_subscriber_ = node_.subscribe<Homography>(
        "tracker/homography", 10, [this](const HomographyConstPtr& message) { homography_ = *message; });
    ASSERT_TRUE(bench_.waitFor([this] { return homography_.has_value(); }, 20.0));

    ASSERT_TRUE(ros::service::waitForService("tracker/select_roi", 10000));
    SelectRoi select;
    select.request.roi.x_offset = 260;
    select.request.roi.y_offset = 180;
    select.request.roi.width = select.request.roi.height = 120;
    ASSERT_TRUE(ros::service::call("tracker/select_roi", select));
    ASSERT_TRUE(select.response.success) << select.response.message;
    bench_.truth().hand({0.08, 0.05, 0.0, 0.01}, 2.0);
    ASSERT_TRUE(bench_.waitFor([this] { return bench_.jointsMove(); }));
    ASSERT_TRUE(bench_.waitFor([this] { return !bench_.jointsMove(); }));
    ASSERT_EQ(homography_->state, Homography::TRACKING);

    ASSERT_TRUE(ros::service::waitForService("controller/engage", 10000));
    std_srvs::SetBool engage;
    engage.request.data = static_cast<std::uint8_t>(true);
    ASSERT_TRUE(ros::service::call("controller/engage", engage));
    EXPECT_FALSE(engage.response.success);
    EXPECT_NE(engage.response.message.find("robot is not enabled"), std::string::npos) << engage.response.message;
    ASSERT_TRUE(bench_.call("enable").success);
    ASSERT_TRUE(bench_.waitFor([this] { return bench_.stateIs("ENABLED"); }));
    // The controller may hear of it a moment later.
    ASSERT_TRUE(bench_.waitFor([&] {
      return ros::service::call("controller/engage", engage) && engage.response.success;
    })) << engage.response.message;
    ASSERT_TRUE(bench_.waitFor([this] { return bench_.jointsMove(); }));
  }

  std::unique_ptr<ChildProcess> start(const std::string& program, const std::vector<std::string>& arguments) {
    return std::make_unique<ChildProcess>(program, arguments);
  }
  void killAndExpectStandstill(ChildProcess& victim) {
    victim.kill(SIGKILL);
    EXPECT_LT(bench_.timeToStandStill(kStandStill + 1.0), kStandStill);
    // And so it stays.
    EXPECT_LT(bench_.motionWithin(1.0), 1e-9);
  }

  // Somebody stops the arm and enables it again at once: it stands until somebody engages.
  void expectLostAfter(const std::function<void()>& stop) {
    std::optional<ControllerState> state;
    const ros::Subscriber subscriber = node_.subscribe<ControllerState>(
        "controller/state", 10, [&](const ControllerStateConstPtr& message) { state = *message; });
    ASSERT_TRUE(bench_.waitFor([&] { return state && state->state == ControllerState::SERVO; }));
    stop();
    ASSERT_TRUE(bench_.waitFor([&] { return bench_.call("enable").success && bench_.stateIs("ENABLED"); }));
    ASSERT_TRUE(bench_.waitFor([&] { return state->state == ControllerState::LOST; })) << state->reason;
    EXPECT_NE(state->reason.find("engage again"), std::string::npos) << state->reason;
    EXPECT_LT(bench_.timeToStandStill(kStandStill), kStandStill);
    EXPECT_LT(bench_.motionWithin(1.0), 1e-9);
  }

  ros::NodeHandle node_;
  AesopBench bench_{false};
  std::unique_ptr<ChildProcess> camera_;
  std::unique_ptr<ChildProcess> tracker_;
  std::unique_ptr<ChildProcess> controller_;
  ros::Subscriber homography_subscriber_;
  std::optional<Homography> homography_;
};

TEST_F(CartStops, WhenTheCameraDies) {
  killAndExpectStandstill(*camera_);
}

TEST_F(CartStops, WhenTheTrackerDies) {
  killAndExpectStandstill(*tracker_);
}

TEST_F(CartStops, WhenTheControllerDies) {
  killAndExpectStandstill(*controller_);
}

TEST_F(CartStops, WhenSomebodyDisablesAndEnablesAtOnce) {
  expectLostAfter([this] { EXPECT_TRUE(bench_.call("disable").success); });
}

TEST_F(CartStops, WhenTheNodeOfTheRobotDies) {
  killAndExpectStandstill(bench_.node());
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "cart_stops_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
