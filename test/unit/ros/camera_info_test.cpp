#include "laparoscope_servo/ros/camera_info.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

namespace laparoscope_servo::skin {
namespace {

const cv::Size kSize(640, 480);

sensor_msgs::CameraInfo info() {
  sensor_msgs::CameraInfo result;
  result.width = 640;
  result.height = 480;
  result.K = {400.0, 0.0, 320.0, 0.0, 410.0, 240.0, 0.0, 0.0, 1.0};
  result.P = {390.0, 0.0, 310.0, 0.0, 0.0, 395.0, 230.0, 0.0, 0.0, 0.0, 1.0, 0.0};
  return result;
}

std::string errorOf(const sensor_msgs::CameraInfo& message, ImageKind kind = ImageKind::kRaw) {
  try {
    cameraFromInfo(message, kind, kSize);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(CameraFromInfo, TakesKOfRawAndPOfRectifiedImages) {
  const geometry::PinholeCamera raw = cameraFromInfo(info(), ImageKind::kRaw, kSize);
  EXPECT_EQ(raw.fx, 400.0);
  EXPECT_EQ(raw.fy, 410.0);
  EXPECT_EQ(raw.cx, 320.0);
  EXPECT_EQ(raw.cy, 240.0);
  const geometry::PinholeCamera rectified = cameraFromInfo(info(), ImageKind::kRectified, kSize);
  EXPECT_EQ(rectified.fx, 390.0);
  EXPECT_EQ(rectified.fy, 395.0);
  EXPECT_EQ(rectified.cx, 310.0);
  EXPECT_EQ(rectified.cy, 230.0);
}

TEST(CameraFromInfo, RefusesWhatIsNoCamera) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -400.0, nan, infinity}) {
    for (const int index : {0, 4}) {
      sensor_msgs::CameraInfo message = info();
      message.K[index] = bad;
      EXPECT_NE(errorOf(message).find("focal"), std::string::npos) << index << ": " << bad;
    }
  }
  for (const int index : {2, 5}) {
    sensor_msgs::CameraInfo message = info();
    message.K[index] = nan;
    EXPECT_NE(errorOf(message).find("principal point"), std::string::npos);
  }
  EXPECT_NE(errorOf(sensor_msgs::CameraInfo()), "");
}

TEST(CameraFromInfo, RefusesImagesOfAnotherSizeUnlessItHasNone) {
  sensor_msgs::CameraInfo message = info();
  message.width = 1920;
  message.height = 1080;
  const std::string error = errorOf(message);
  EXPECT_NE(error.find("1920x1080"), std::string::npos) << error;
  EXPECT_NE(error.find("640x480"), std::string::npos) << error;
  message.width = message.height = 0;
  EXPECT_EQ(errorOf(message), "");
}

TEST(CameraFromInfo, FollowsBinningAndTheDriversRegion) {
  sensor_msgs::CameraInfo message = info();
  message.width = 1600;
  message.height = 1200;
  message.binning_x = message.binning_y = 2;
  message.roi.x_offset = 100;
  message.roi.y_offset = 60;
  message.roi.width = 1280;
  message.roi.height = 960;
  const geometry::PinholeCamera camera = cameraFromInfo(message, ImageKind::kRaw, kSize);
  EXPECT_EQ(camera.fx, 200.0);
  EXPECT_EQ(camera.fy, 205.0);
  EXPECT_EQ(camera.cx, 110.0);
  EXPECT_EQ(camera.cy, 90.0);
}

TEST(IntrinsicsTest, SayWhyThereAreNone) {
  Intrinsics intrinsics(ImageKind::kRaw);
  intrinsics.update(kSize, false);
  EXPECT_FALSE(intrinsics.camera());
  EXPECT_NE(intrinsics.error().find("no camera_info"), std::string::npos);
  intrinsics.set(sensor_msgs::CameraInfo());
  intrinsics.update(kSize, true);
  EXPECT_FALSE(intrinsics.camera());
  EXPECT_NE(intrinsics.error().find("focal"), std::string::npos);
}

TEST(IntrinsicsTest, MayComeLate) {
  Intrinsics intrinsics(ImageKind::kRaw);
  intrinsics.update(kSize, true);
  intrinsics.set(info());
  intrinsics.update(kSize, false);
  EXPECT_TRUE(intrinsics.camera());
  EXPECT_EQ(intrinsics.error(), "");
}

TEST(IntrinsicsTest, AreInvalidAfterAChangeUntilTheReferenceIsNew) {
  Intrinsics intrinsics(ImageKind::kRaw);
  intrinsics.set(info());
  intrinsics.update(kSize, true);
  sensor_msgs::CameraInfo zoomed = info();
  zoomed.K[0] = 500.0;
  intrinsics.set(zoomed);
  intrinsics.update(kSize, false);
  EXPECT_FALSE(intrinsics.camera());
  EXPECT_NE(intrinsics.error().find("fx = 400"), std::string::npos) << intrinsics.error();
  EXPECT_NE(intrinsics.error().find("fx = 500"), std::string::npos) << intrinsics.error();
  intrinsics.update(kSize, false);
  EXPECT_FALSE(intrinsics.camera());
  intrinsics.update(kSize, true);
  ASSERT_TRUE(intrinsics.camera());
  EXPECT_EQ(intrinsics.camera()->fx, 500.0);
}

TEST(IntrinsicsTest, ComeBackAfterOneBadMessage) {
  Intrinsics intrinsics(ImageKind::kRaw);
  intrinsics.set(info());
  intrinsics.update(kSize, true);
  intrinsics.set(sensor_msgs::CameraInfo());
  intrinsics.update(kSize, false);
  EXPECT_FALSE(intrinsics.camera());
  intrinsics.set(info());
  intrinsics.update(kSize, false);
  EXPECT_TRUE(intrinsics.camera());
}

TEST(IntrinsicsTest, TellOfDistortionThatNobodyCorrects) {
  sensor_msgs::CameraInfo message = info();
  message.D = {0.0, 0.0, 0.0, 0.0, 0.0};
  Intrinsics raw(ImageKind::kRaw);
  raw.set(message);
  raw.update(kSize, true);
  EXPECT_FALSE(raw.ignoresDistortion());
  message.D[0] = -0.3;
  raw.set(message);
  raw.update(kSize, true);
  EXPECT_TRUE(raw.ignoresDistortion());
  Intrinsics rectified(ImageKind::kRectified);
  rectified.set(message);
  rectified.update(kSize, true);
  EXPECT_FALSE(rectified.ignoresDistortion());
}

}  // namespace
}  // namespace laparoscope_servo::skin
