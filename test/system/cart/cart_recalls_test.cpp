// demo.launch, a scope that is moved by hand from view to view, and the loop that brings it back to the first one
// through those between.
#include <gtest/gtest.h>
#include <laparoscope_servo/SelectRoi.h>
#include <laparoscope_servo/StoredView.h>
#include <laparoscope_servo/TaskError.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "laparoscope_servo/sim/emulator_control_client.h"

namespace laparoscope_servo {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kStep = 13.0 * kDegree;  // the first view and the third share too little to be found in each other
constexpr double kFocalLength = 400.0;    // px, of config/simulation.yaml

class CartRecalls : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* service : {"/tracker/select_roi", "/tracker/recall_view", "/aesop/enable", "/controller/engage"}) {
      ASSERT_TRUE(ros::service::waitForService(service, 20000)) << service;
    }
    std::string control;
    ASSERT_TRUE(ros::param::get("~control", control));
    emulator_ = std::make_unique<sim::EmulatorControlClient>(control);
    ASSERT_TRUE(waitFor([this] { return error_ != nullptr; }, 20.0)) << "no image is processed";
  }

  bool waitFor(const std::function<bool()>& condition, double seconds) {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
    while (ros::WallTime::now() < end) {
      ros::spinOnce();
      if (condition()) return true;
      ros::WallDuration(0.01).sleep();
    }
    return condition();
  }

  // Selects what is in the middle and stores it.
  void store(const std::string& name) {
    SelectRoi selection;
    selection.request.roi.x_offset = 255;
    selection.request.roi.y_offset = 175;
    selection.request.roi.width = selection.request.roi.height = 130;
    ASSERT_TRUE(ros::service::call("/tracker/select_roi", selection) && selection.response.success)
        << selection.response.message;
    ASSERT_TRUE(waitFor([this] { return error_->valid; }, 5.0));
    StoredView view;
    view.request.name = name;
    ASSERT_TRUE(ros::service::call("/tracker/store_view", view) && view.response.success) << view.response.message;
  }

  // By hand, as a nurse would: the arm is DISABLED.
  void turn(double pan, double spin) {
    emulator_->hand({pan, 0.0, spin, 0.0}, 1.5);
    waitFor([] { return false; }, 2.0);
  }

  // px, from where the region is to where it has to be.
  double off() const {
    if (!error_->valid) return std::numeric_limits<double>::infinity();
    return kFocalLength * std::hypot(error_->x - error_->desired_x, error_->y - error_->desired_y);
  }

  ros::NodeHandle node_;
  TaskErrorConstPtr error_;
  ros::Subscriber errors_ =
      node_.subscribe<TaskError>("/tracker/task_error", 1, [this](const TaskErrorConstPtr& error) { error_ = error; });
  std::unique_ptr<sim::EmulatorControlClient> emulator_;
};

TEST_F(CartRecalls, ReturnsToAViewThroughThoseBetween) {
  turn(-kStep, 0.0);
  store("first");
  const aesop::JointVector first = emulator_->state().q;
  turn(kStep, 5.0 * kDegree);
  store("second");
  turn(kStep, -5.0 * kDegree);
  store("third");

  std_srvs::Trigger enable;
  ASSERT_TRUE(ros::service::call("/aesop/enable", enable) && enable.response.success) << enable.response.message;
  std_srvs::SetBool engage;
  engage.request.data = true;
  ASSERT_TRUE(waitFor([&] { return ros::service::call("/controller/engage", engage) && engage.response.success; }, 5.0))
      << engage.response.message;
  StoredView recall;
  recall.request.name = "first";
  ASSERT_TRUE(ros::service::call("/tracker/recall_view", recall) && recall.response.success) << recall.response.message;
  EXPECT_NE(recall.response.message.find("second"), std::string::npos) << "the way: " << recall.response.message;

  // At the view itself, and at rest there.
  const auto away = [&] { return (emulator_->state().q - first).cwiseAbs().maxCoeff(); };
  ASSERT_TRUE(waitFor([&] { return off() < 2.0 && away() < 0.02; }, 30.0)) << off() << " px, " << away() << " rad or m";
  waitFor([] { return false; }, 1.0);
  EXPECT_LT(off(), 2.0);
  EXPECT_LT(std::abs(error_->alpha - error_->desired_alpha), 1.0 * kDegree);
  EXPECT_LT(away(), 0.01);
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "cart_recalls_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
