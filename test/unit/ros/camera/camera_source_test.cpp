#include "ros/camera/camera_source.h"

#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/videoio.hpp>

#include "support/error_text.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

TEST(CaptureStamp, IsTheTimeAtWhichThePictureWasTaken) {
  const ros::Time now(1000.0);
  EXPECT_NEAR(captureStamp(49.97, 50.0, now).toSec(), 999.97, 1e-6);
  EXPECT_EQ(captureStamp(50.0, 50.0, now), now);
}

TEST(CaptureStamp, ThatCannotBeIsThatOfTheArrival) {
  const ros::Time now(1000.0);
  EXPECT_EQ(captureStamp(50.1, 50.0, now), now) << "from the future";
  EXPECT_EQ(captureStamp(48.9, 50.0, now), now) << "of another clock";
  EXPECT_EQ(captureStamp(std::nan(""), 50.0, now), now);
  EXPECT_EQ(captureStamp(49.5, 50.0, ros::Time(0.1)), ros::Time(0.1)) << "a stamp is not below zero";
}

class CameraSourceTest : public testing::Test {
 protected:
  CameraSourceTest() { ros::Time::init(); }

  test_support::TemporaryFolder folder_;
  CameraConfig config_;
};

TEST_F(CameraSourceTest, GivesTheFilesPicturesAndThenItsEnd) {
  config_.device = folder_.file("a.avi");
  {
    cv::VideoWriter writer(config_.device, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 200.0, {64, 48});
    for (int k = 0; k < 4; ++k) writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(40 + 40 * k)));
  }
  config_.delay = 5.0;
  CameraSource source(config_);
  ros::Time last;
  std::vector<cv::Mat> kept;
  for (int k = 0; k < 4; ++k) {
    const auto picture = source.next();
    ASSERT_TRUE(picture);
    EXPECT_GT(picture->stamp, last);
    EXPECT_LT(picture->stamp, ros::Time::now() - ros::Duration(4.9));
    last = picture->stamp;
    kept.push_back(picture->image);
  }
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(kept[static_cast<std::size_t>(k)].at<cv::Vec3b>(24, 32)[1], 40 + 40 * k, 3)
        << "each has its own pixels";
  }
  try {
    source.next();
    FAIL() << "there is no fifth";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("has ended"), std::string::npos) << error.what();
  }
}

TEST_F(CameraSourceTest, SaysWhatCannotBeOpened) {
  const auto error = [this](const std::string& device) -> std::string {
    config_.device = device;
    return test_support::errorText<std::runtime_error>([&] { CameraSource source(config_); });
  };
  EXPECT_NE(error("/dev/video77").find("/dev/video0"), std::string::npos);
  std::ofstream(folder_.file("text.avi")) << "no video";
  EXPECT_NE(error(folder_.file("text.avi")).find("cannot be opened"), std::string::npos);
  EXPECT_NE(error("/dev/null").find("cannot be opened"), std::string::npos);
}

TEST(CameraParameters, AreJudged) {
  CameraConfig config;
  EXPECT_TRUE(validate(config).empty());
  config.width = 640;
  EXPECT_EQ(validate(config).size(), 1u) << "without a height";
  config.height = 480;
  EXPECT_TRUE(validate(config).empty());
  config.pixel_format = "MJPEG";
  config.name = "../x";
  EXPECT_EQ(validate(config).size(), 2u);
}

TEST(CalibrationFile, IsWhereOtherCamerasHaveIt) {
  ::setenv("ROS_HOME", "/somewhere", 1);
  EXPECT_EQ(calibrationFile("left"), "/somewhere/camera_info/left.yaml");
  ::unsetenv("ROS_HOME");
  ::setenv("HOME", "/home/x", 1);
  EXPECT_EQ(calibrationFile("left"), "/home/x/.ros/camera_info/left.yaml");
}

}  // namespace
}  // namespace laparoscope_servo
