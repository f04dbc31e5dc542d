// The simulated camera with the emulator, both as processes.
#include <gtest/gtest.h>
#include <std_srvs/Trigger.h>

#include <memory>
#include <opencv2/imgproc.hpp>

#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/sim/arm.h"
#include "laparoscope_servo/sim/emulator_control_client.h"
#include "laparoscope_servo/sim/tissue.h"
#include "node_bench.h"
#include "ros/aesop/aesop_parameters.h"
#include "ros/tracker/image_conversion.h"

namespace laparoscope_servo::test {
namespace {

class SimulatedCamera : public testing::Test {
 protected:
  SimulatedCamera() : images_(node_, "image_raw"), infos_(node_, "camera_info") {
    parameters_ = parametersFromYaml(std::string(LAPAROSCOPE_SERVO_CONFIG) + "/simulation.yaml");
    parameters_["control"] = control();
    parameters_["tissue"]["texture_side"] = 1200;
    parameters_["exposure"]["automatic"] = false;
    parameters_["camera"]["noise"] = 0.0;
    parameters_["instrument"]["crossing_time"] = 1.0;
  }
  ~SimulatedCamera() override { ros::param::del("/simulated_camera"); }

  std::string control() const { return folder_.file("control"); }

  void startEmulator() {
    emulator_ = std::make_unique<ChildProcess>(
        AESOP_EMULATOR, std::vector<std::string>{"--link", folder_.file("port"), "--control", control()},
        folder_.file("emulator.log"));
    ASSERT_TRUE(spinUntil([this] {
      try {
        truth_ = std::make_unique<sim::EmulatorControlClient>(control());
      } catch (const std::runtime_error&) {
        return false;
      }
      return true;
    }));
  }
  void startCamera() {
    ros::param::set("/simulated_camera", parameters_);
    camera_ = std::make_unique<ChildProcess>(SIMULATED_CAMERA, std::vector<std::string>{"__name:=simulated_camera"},
                                             folder_.file("camera.log"));
  }
  void startBoth() {
    startEmulator();
    startCamera();
    ASSERT_TRUE(next());
  }
  // Waits for images that were taken from now on; false when none comes.
  bool next(std::size_t count = 2, double seconds = 10.0) {
    images_.all.clear();
    infos_.all.clear();
    return spinUntil([&] { return images_.all.size() >= count && infos_.all.size() >= count; }, seconds);
  }
  cv::Mat grey() const {
    cv::Mat image;
    cv::cvtColor(trackerImage(*images_.all.back()), image, cv::COLOR_BGR2GRAY);
    image.convertTo(image, CV_32F);
    return image;
  }

  test_support::TemporaryFolder folder_;
  ros::NodeHandle node_;
  XmlRpc::XmlRpcValue parameters_;
  std::unique_ptr<ChildProcess> emulator_;
  std::unique_ptr<ChildProcess> camera_;
  std::unique_ptr<sim::EmulatorControlClient> truth_;
  Recorder<sensor_msgs::Image> images_;
  Recorder<sensor_msgs::CameraInfo> infos_;
};

TEST_F(SimulatedCamera, PublishesImagesWithTheirIntrinsicsAsADriverWould) {
  startBoth();
  ASSERT_TRUE(next(5));
  for (std::size_t k = 0; k < 5; ++k) {
    const sensor_msgs::Image& image = *images_.all[k];
    EXPECT_EQ(image.encoding, "bgr8");
    EXPECT_EQ(image.width, 640U);
    EXPECT_EQ(image.height, 480U);
    EXPECT_EQ(image.header.frame_id, "laparoscope_optical");
    EXPECT_EQ(infos_.all[k]->header.stamp, image.header.stamp);
    EXPECT_EQ(infos_.all[k]->header.frame_id, image.header.frame_id);
    EXPECT_EQ(infos_.all[k]->K[0], 400.0);
    EXPECT_EQ(infos_.all[k]->P[6], 239.5);
    if (k > 0) {
      EXPECT_GT(image.header.stamp, images_.all[k - 1]->header.stamp);
    }
  }
}

TEST_F(SimulatedCamera, FollowsTheArmByTheTrueHomography) {
  startBoth();
  const cv::Mat before = grey();
  const aesop::JointVector start = truth_->state().q;
  truth_->hand({0.05, -0.04, 0.1, 0.01}, 0.5);
  ASSERT_TRUE(spinUntil([&] { return truth_->motion().moving; }));
  ASSERT_TRUE(spinUntil([&] { return !truth_->motion().moving; }));
  ASSERT_TRUE(next());
  const cv::Mat after = grey();

  const aesop::Kinematics kinematics{aesop::KinematicsConfig()};
  const Eigen::Isometry3d reference = kinematics.optical(start), current = kinematics.optical(truth_->state().q);
  const geometry::PinholeCamera camera = geometry::cameraFromRowMajor(infos_.all.back()->K.data());
  const Eigen::Matrix3d g =
      sim::trueHomography(camera, sim::placeTissue(sim::TissueConfig(), reference), reference, current);
  cv::Matx33d m;
  for (int k = 0; k < 9; ++k) m.val[k] = g(k / 3, k % 3);
  cv::Mat back;
  cv::warpPerspective(after, back, m, before.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  const cv::Rect middle(270, 190, 100, 100);
  cv::Mat score, unmoved;
  cv::matchTemplate(back(middle), before(middle), score, cv::TM_CCOEFF_NORMED);
  cv::matchTemplate(after(middle), before(middle), unmoved, cv::TM_CCOEFF_NORMED);
  EXPECT_GT(score.at<float>(0), 0.95);
  EXPECT_LT(unmoved.at<float>(0), 0.8);
}

TEST_F(SimulatedCamera, TheInstrumentCrossesOnDemandOnce) {
  startBoth();
  const cv::Mat clear = grey();
  const auto differs = [&] { return cv::norm(grey(), clear, cv::NORM_INF) > 30.0; };
  EXPECT_FALSE(differs());
  std_srvs::Trigger call;
  ASSERT_TRUE(ros::service::call("/simulated_camera/cross_instrument", call));
  EXPECT_TRUE(call.response.success);
  EXPECT_TRUE(spinUntil(differs));
  EXPECT_TRUE(spinUntil([&] { return !differs(); }));
  ASSERT_TRUE(next(5));
  EXPECT_FALSE(differs());
}

TEST_F(SimulatedCamera, StopsWithTheEmulatorAndComesBackWithIt) {
  startBoth();
  emulator_->kill(SIGKILL);
  ASSERT_EQ(emulator_->exitStatus(2.0), -1);
  // What was under way may still arrive.
  spinUntil([] { return false; }, 0.3);
  EXPECT_FALSE(next(1, 1.0));
  EXPECT_TRUE(camera_->isRunning());
  EXPECT_NE(contents(folder_.file("camera.log")).find("the emulated arm does not answer at " + control()),
            std::string::npos);
  startEmulator();
  EXPECT_TRUE(next());
}

TEST_F(SimulatedCamera, ListsAllErrorsInItsParametersAndRefusesToStart) {
  parameters_["camera"]["rate"] = -1.0;
  parameters_["tissue"]["wdith"] = 0.3;
  parameters_["emulator"]["delay"] = "long";
  XmlRpc::XmlRpcValue without_control;
  for (auto& member : parameters_) {
    if (member.first != "control") without_control[member.first] = member.second;
  }
  parameters_ = without_control;
  startCamera();
  EXPECT_EQ(camera_->exitStatus(10.0), 1);
  const std::string log = contents(folder_.file("camera.log"));
  for (const char* part : {"camera/rate", "tissue/wdith", "emulator/delay", "control is not set"}) {
    EXPECT_NE(log.find(part), std::string::npos) << part << " in\n" << log;
  }
}

TEST_F(SimulatedCamera, RefusesATextureThatIsNoImage) {
  parameters_["tissue"]["image"] = folder_.file("missing.png");
  startCamera();
  EXPECT_EQ(camera_->exitStatus(10.0), 1);
  EXPECT_NE(contents(folder_.file("camera.log")).find("missing.png"), std::string::npos);
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "simulated_camera_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
