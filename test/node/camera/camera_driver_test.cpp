// The node and nodelet `camera` and the tool calibrate_camera as processes, with files that the test makes.
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "node/sim/node_bench.h"
#include "support/board_pictures.h"

namespace laparoscope_servo::test {
namespace {

constexpr int kImages = 5;

class Camera : public testing::Test {
 protected:
  Camera() { ::setenv("ROS_HOME", folder_.path().c_str(), 1); }
  ~Camera() override { ros::param::del("/camera"); }

  void writeVideo(const std::string& file) {
    const std::string beside = folder_.file("beside.avi");
    {
      cv::VideoWriter writer(beside, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 50.0, {64, 48});
      for (int k = 0; k < kImages; ++k) writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(30 + 40 * k)));
    }
    std::filesystem::rename(beside, file);
  }
  void start(const std::string& device) {
    images_ = std::make_unique<Recorder<sensor_msgs::Image>>(node_, "image_raw");
    infos_ = std::make_unique<Recorder<sensor_msgs::CameraInfo>>(node_, "camera_info");
    ros::param::set("/camera/device", device);
    ros::param::set("/camera/retry_period", 0.2);
    process_ = std::make_unique<ChildProcess>(CAMERA, std::vector<std::string>{"__name:=camera"}, log());
  }
  bool come(std::size_t count) {
    return spinUntil([&] { return images_->all.size() >= count && infos_->all.size() >= count; });
  }
  // The first of either may have come before the other's connection.
  bool belongTogether() const {
    return std::any_of(infos_->all.begin(), infos_->all.end(), [this](const auto& info) {
      return std::any_of(images_->all.begin(), images_->all.end(),
                         [&](const auto& image) { return image->header.stamp == info->header.stamp; });
    });
  }
  static int grey(const sensor_msgs::Image& image) { return image.data[image.data.size() / 2]; }
  bool logHas(const std::string& text) const { return contents(log()).find(text) != std::string::npos; }
  std::string log() const { return folder_.file("camera.log"); }

  test_support::TemporaryFolder folder_;
  ros::NodeHandle node_;
  std::unique_ptr<Recorder<sensor_msgs::Image>> images_;
  std::unique_ptr<Recorder<sensor_msgs::CameraInfo>> infos_;
  std::unique_ptr<ChildProcess> process_;
};

TEST_F(Camera, PublishesEachPictureOnceWithItsStampAndSaysThatItIsNotCalibrated) {
  writeVideo(folder_.file("a.avi"));
  ASSERT_NO_FATAL_FAILURE(start(folder_.file("a.avi")));
  ASSERT_TRUE(come(3)) << contents(log());
  for (std::size_t k = 0; k < 3; ++k) {
    const sensor_msgs::Image& image = *images_->all[k];
    EXPECT_EQ(image.encoding, sensor_msgs::image_encodings::BGR8);
    EXPECT_EQ(image.header.frame_id, "laparoscope_optical");
    EXPECT_EQ(infos_->all[k]->K[0], 0.0);
    EXPECT_EQ(infos_->all[k]->width, 64u);
  }
  for (std::size_t k = 1; k < 3; ++k) {
    EXPECT_GT(images_->all[k]->header.stamp, images_->all[k - 1]->header.stamp);
    EXPECT_NE(grey(*images_->all[k]), grey(*images_->all[k - 1]));
  }
  EXPECT_TRUE(logHas("not calibrated")) << contents(log());
}

TEST_F(Camera, ADeviceThatVanishesIsSaidAndComesBack) {
  const std::string device = folder_.file("a.avi");
  writeVideo(device);
  ASSERT_NO_FATAL_FAILURE(start(device));
  ASSERT_TRUE(come(1)) << contents(log());
  std::filesystem::remove(device);
  ASSERT_TRUE(spinUntil([this] { return logHas("is not there"); })) << contents(log());
  ros::spinOnce();
  const std::size_t before = images_->all.size();
  EXPECT_LE(before, static_cast<std::size_t>(kImages) * 2) << "nothing is repeated";
  writeVideo(device);
  EXPECT_TRUE(come(before + 3)) << contents(log());
  EXPECT_TRUE(process_->isRunning());
}

TEST_F(Camera, RefusesACalibrationThatIsNotThere) {
  ros::param::set("/camera/calibration", folder_.file("none.yaml"));
  ASSERT_NO_FATAL_FAILURE(start(folder_.file("a.avi")));
  EXPECT_EQ(process_->exitStatus(20.0), 1);
  EXPECT_TRUE(logHas("none.yaml")) << contents(log());
}

TEST_F(Camera, IsCalibratedByAPrintedBoardAndLoadsTheResultByItsName) {
  std::filesystem::create_directory(folder_.file("board"));
  const auto pictures = test_support::boardPictures({});
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    cv::imwrite(folder_.file("board/" + std::to_string(k) + ".png"), pictures[k]);
  }
  ChildProcess tool(CALIBRATE_CAMERA, {folder_.file("board"), "--name", "scope", "--interval", "0"}, log());
  ASSERT_EQ(tool.exitStatus(120.0), 0) << contents(log());
  ASSERT_TRUE(std::filesystem::exists(folder_.file("camera_info/scope.yaml"))) << contents(log());

  {
    cv::VideoWriter writer(folder_.file("b.avi"), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 50.0, {640, 480});
    for (int k = 0; k < 3; ++k) writer.write(cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(30 + 40 * k)));
  }
  ros::param::set("/camera/name", "scope");
  ASSERT_NO_FATAL_FAILURE(start(folder_.file("b.avi")));
  ASSERT_TRUE(come(1)) << contents(log());
  EXPECT_NEAR(infos_->all[0]->K[0], 520.0, 5.0);
  EXPECT_TRUE(spinUntil([this] { return belongTogether(); })) << "no picture has the stamp of a camera_info";

  writeVideo(folder_.file("b.avi"));  // another size
  ASSERT_TRUE(spinUntil([this] { return infos_->all.back()->width == 64; })) << contents(log());
  EXPECT_EQ(infos_->all.back()->K[0], 0.0) << "nobody takes it for these pictures";
  EXPECT_TRUE(logHas("is for pictures of 640x480")) << contents(log());
}

TEST_F(Camera, TheToolSaysWhatIsWrong) {
  ChildProcess none(CALIBRATE_CAMERA, {folder_.file("nothing")}, log());
  EXPECT_EQ(none.exitStatus(20.0), 1);
  ChildProcess board(CALIBRATE_CAMERA, {"--print", folder_.file("board.svg"), "--board", "9by6"}, log());
  EXPECT_EQ(board.exitStatus(20.0), 1);
  EXPECT_TRUE(logHas("9by6"));
  ChildProcess option(CALIBRATE_CAMERA, {"--bord", "9x6"}, log());
  EXPECT_EQ(option.exitStatus(20.0), 2);
  ChildProcess print(CALIBRATE_CAMERA, {"--print", folder_.file("board.svg")}, log());
  EXPECT_EQ(print.exitStatus(20.0), 0);
  EXPECT_NE(contents(folder_.file("board.svg")).find("<svg"), std::string::npos);
}

TEST_F(Camera, RunsInTheManagerOfTheTracker) {
  writeVideo(folder_.file("a.avi"));
  ros::param::set("/camera/device", folder_.file("a.avi"));
  images_ = std::make_unique<Recorder<sensor_msgs::Image>>(node_, "image_raw");
  infos_ = std::make_unique<Recorder<sensor_msgs::CameraInfo>>(node_, "camera_info");
  nodelet::Loader loader(false);
  ASSERT_TRUE(loader.load("/camera", "laparoscope_servo/Camera", {}, {}));
  EXPECT_TRUE(come(3));
  EXPECT_TRUE(loader.unload("/camera"));
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "camera_driver_test");
  ros::NodeHandle keeps_ros_up;
  return RUN_ALL_TESTS();
}
