#include "ros/tracker/camera_info.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "support/error_text.h"

namespace laparoscope_servo {
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
  return test_support::errorText<std::invalid_argument>([&] { cameraFromInfo(message, kind, kSize); });
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

TEST(CameraFromInfo, RefusesARegionThatIsNotOnTheSensorAndBinningThatDoesNotFit) {
  const std::vector<std::pair<std::function<void(sensor_msgs::CameraInfo&)>, std::string>> cases = {
      {[](auto& m) { m.roi.x_offset = 400; }, "roi ends at x = 1680, the sensor has 1600 px"},
      {[](auto& m) { m.roi.y_offset = 4000000000u; }, "roi ends at y = 4000000960"},
      {[](auto& m) { m.roi.width = 4294967295u; }, "roi ends at x"},
      {[](auto& m) { m.roi.width = m.roi.height = 0; }, "roi begins at x = 100 and has no size"},
      {[](auto& m) { m.binning_x = 3; }, "images of 426x480 (binning 3x2), the image has 640x480"},
      {[](auto& m) { m.binning_x = m.binning_y = 1; }, "images of 1280x960, the image has 640x480"},
      {[](auto& m) { m.binning_x = 4294967295u; }, "images of 0x480"},
      {[](auto& m) { m.width = m.height = 0, m.binning_x = 1; }, "images of 1280x480"},
  };
  for (const auto& [spoil, expected] : cases) {
    sensor_msgs::CameraInfo message = info();
    message.width = 1600;
    message.height = 1200;
    message.binning_x = message.binning_y = 2;
    message.roi.x_offset = 100;
    message.roi.y_offset = 60;
    message.roi.width = 1280;
    message.roi.height = 960;
    ASSERT_EQ(errorOf(message), "");
    spoil(message);
    EXPECT_NE(errorOf(message).find(expected), std::string::npos) << errorOf(message);
  }
}

TEST(CameraFromInfo, RefusesNumbersThatNoCameraOfThisSizeHas) {
  const std::vector<std::pair<std::function<void(sensor_msgs::CameraInfo&)>, std::string>> cases = {
      {[](auto& m) { m.K[0] = 1.0; }, "K: fx = 1, expected a focal length of 25.6 to 64000 px"},
      {[](auto& m) { m.K[4] = 1e9; }, "K: fy = 1e+09"},
      {[](auto& m) { m.K[2] = 2000.0; }, "K: cx = 2000, expected a principal point from -320 to 960 px"},
      {[](auto& m) { m.K[5] = -500.0; }, "K: cy = -500"},
      {[](auto& m) { m.P[0] = 1200.0; }, "fx is 400 in K, but 1200 in P"},
      {[](auto& m) { m.P[5] = -395.0; }, "fy is 410 in K, but -395 in P"},
      {[](auto& m) { m.P[0] = std::numeric_limits<double>::quiet_NaN(); }, "but nan in P"},
  };
  for (const auto& [spoil, expected] : cases) {
    sensor_msgs::CameraInfo message = info();
    spoil(message);
    EXPECT_NE(errorOf(message).find(expected), std::string::npos) << errorOf(message);
  }
  sensor_msgs::CameraInfo without_p = info();
  without_p.P.fill(0.0);
  EXPECT_EQ(errorOf(without_p), "");
  sensor_msgs::CameraInfo bad_p = info();
  bad_p.P[2] = 1e6;
  EXPECT_EQ(errorOf(bad_p), "") << "K is asked for";
  EXPECT_NE(errorOf(bad_p, ImageKind::kRectified).find("P: cx = 1e+06"), std::string::npos);
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

sensor_msgs::CameraInfo lensInfo() {
  sensor_msgs::CameraInfo result = info();
  result.distortion_model = "plumb_bob";
  result.D = {-0.3, 0.1, 0.001, -0.001, 0.02};
  result.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  return result;
}

std::string lensErrorOf(const sensor_msgs::CameraInfo& message) {
  return test_support::errorText<std::invalid_argument>([&] { lensFromInfo(message, kSize); });
}

TEST(LensFromInfo, TakesEveryMatrixAndModel) {
  const image::LensParameters lens = lensFromInfo(lensInfo(), kSize).parameters();
  EXPECT_EQ(lens.distortion, image::Distortion::kPlumbBob);
  EXPECT_EQ(lens.coefficients, (std::array<double, 8>{-0.3, 0.1, 0.001, -0.001, 0.02, 0.0, 0.0, 0.0}));
  EXPECT_EQ(lens.raw.fx, 400.0);
  EXPECT_EQ(lens.rectified.fx, 390.0);
  EXPECT_EQ(lens.rectified.cy, 230.0);
  sensor_msgs::CameraInfo message = lensInfo();
  message.distortion_model = "rational_polynomial";
  message.D = {0.3, 0.1, 0.001, -0.001, 0.02, 0.6, 0.1, 0.01};
  EXPECT_EQ(lensFromInfo(message, kSize).parameters().distortion, image::Distortion::kRationalPolynomial);
  EXPECT_EQ(lensFromInfo(message, kSize).parameters().coefficients[7], 0.01);
  message.distortion_model = "equidistant";
  message.D = {0.01, 0.0, 0.0, 0.002};
  EXPECT_EQ(lensFromInfo(message, kSize).parameters().distortion, image::Distortion::kEquidistant);
}

TEST(LensFromInfo, TurnsAsTheMessageSays) {
  sensor_msgs::CameraInfo message = lensInfo();
  const double c = std::cos(0.1);
  const double s = std::sin(0.1);
  message.R = {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0};
  const auto rectified = lensFromInfo(message, kSize).toRectified({400.0, 240.0});  // to the right of the centre
  ASSERT_TRUE(rectified);
  EXPECT_GT(rectified->y(), message.P[6] + 5.0);
}

TEST(LensFromInfo, MakesDoWithWhatDriversLeaveOut) {
  sensor_msgs::CameraInfo message = lensInfo();
  message.P.fill(0.0);
  message.R.fill(0.0);
  message.D.pop_back();
  const image::LensParameters lens = lensFromInfo(message, kSize).parameters();
  EXPECT_EQ(lens.rectified.fx, lens.raw.fx);
  EXPECT_TRUE(lens.rotation.isIdentity());
  EXPECT_EQ(lens.coefficients[4], 0.0);
  message.distortion_model.clear();
  message.D.assign(3, 0.0);
  EXPECT_EQ(lensErrorOf(message), "");
  EXPECT_EQ(cameraFromInfo(message, ImageKind::kToRectify, kSize).fx, 400.0);
}

TEST(LensFromInfo, FollowsBinning) {
  sensor_msgs::CameraInfo message = lensInfo();
  message.width = 1280;
  message.height = 960;
  message.binning_x = message.binning_y = 2;
  const image::LensParameters lens = lensFromInfo(message, kSize).parameters();
  EXPECT_EQ(lens.raw.fx, 200.0);
  EXPECT_EQ(lens.rectified.fx, 195.0);
}

TEST(LensFromInfo, RefusesWhatIsNoLensAndSaysWhy) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<std::function<void(sensor_msgs::CameraInfo&)>, std::string>> cases = {
      {[](auto& m) { m.distortion_model = "thin_prism"; }, "distortion_model 'thin_prism'"},
      {[](auto& m) { m.distortion_model.clear(); }, "distortion_model ''"},
      {[](auto& m) { m.D.resize(3); }, "3 coefficients, expected 5 for plumb_bob"},
      {[](auto& m) { m.distortion_model = "rational_polynomial"; }, "5 coefficients, expected 8"},
      {[](auto& m) { m.distortion_model = "equidistant"; }, "5 coefficients, expected 4"},
      {[](auto& m) { m.D.resize(100000); }, "100000 coefficients"},
      {[nan](auto& m) { m.D[1] = nan; }, "coefficient nan"},
      {[nan](auto& m) { m.K[0] = nan; }, "K: "},
      {[nan](auto& m) { m.P[6] = nan; }, "P: "},
      {[nan](auto& m) { m.R[0] = nan; }, "R: "},
      {[](auto& m) { m.R[0] = 3.0; }, "R: "},
      {[](auto& m) { m.width = 1920; }, "1920x480, the image has 640x480"},
  };
  for (const auto& [spoil, expected] : cases) {
    sensor_msgs::CameraInfo message = lensInfo();
    spoil(message);
    EXPECT_NE(lensErrorOf(message).find("camera_info"), std::string::npos) << expected;
    EXPECT_NE(lensErrorOf(message).find(expected), std::string::npos) << lensErrorOf(message);
  }
}

TEST(LensSourceTest, GivesTheSameLensUntilTheCalibrationChanges) {
  LensSource source;
  EXPECT_FALSE(source.lensFor(kSize));
  EXPECT_NE(source.error().find("no camera_info"), std::string::npos);
  sensor_msgs::CameraInfo message = lensInfo();
  source.set(message);
  const auto lens = source.lensFor(kSize);
  ASSERT_TRUE(lens);
  message.header.stamp.sec = 7;
  source.set(message);
  EXPECT_EQ(source.lensFor(kSize), lens) << "it would be worked out for every image";
  EXPECT_FALSE(source.lensFor(cv::Size(320, 240)));
  EXPECT_NE(source.error(), "");
  EXPECT_TRUE(source.lensFor(kSize));
  message.D[0] = std::numeric_limits<double>::quiet_NaN();
  source.set(message);
  EXPECT_FALSE(source.lensFor(kSize));
  EXPECT_NE(source.error().find("nan"), std::string::npos) << source.error();
}

}  // namespace
}  // namespace laparoscope_servo
