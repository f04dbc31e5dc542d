#include "laparoscope_servo/sim/scope_camera.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::sim {
namespace {

const Eigen::Isometry3d kStart = Eigen::Isometry3d::Identity();

SceneConfig small() {
  SceneConfig config;
  config.camera.width = 320;
  config.camera.height = 240;
  config.camera.intrinsics = {200.0, 200.0, 159.5, 119.5};
  config.tissue.texture_side = 600;
  return config;
}

ScopeCamera make(const SceneConfig& config) {
  return {config, placeTissue(config.tissue, kStart)};
}

double brightness(const cv::Mat& image) {
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return cv::mean(grey)[0];
}

TEST(ScopeCamera, GivesTheSameImagesForTheSamePosesAndTimes) {
  ScopeCamera a = make(small()), b = make(small());
  for (int k = 0; k < 3; ++k) {
    const Eigen::Isometry3d pose(Eigen::Translation3d(0.002 * k, 0.0, 0.001 * k));
    const Eigen::Vector3d tip(0.01 * k, 0.0, -0.02);
    const RenderedImage first = a.render(pose, 0.04 * k, tip), second = b.render(pose, 0.04 * k, tip);
    EXPECT_EQ(cv::norm(first.image, second.image, cv::NORM_INF), 0.0);
    EXPECT_EQ(first.gain, second.gain);
  }
}

TEST(ScopeCamera, NoiseHasTheStandardDeviationAskedForAndIsNewInEachImage) {
  SceneConfig config = small();
  config.exposure.automatic = false;
  config.camera.noise = 0.0;
  const cv::Mat clean = make(config).render(kStart, 0.0).image;
  config.camera.noise = 3.0;
  ScopeCamera camera = make(config);
  const cv::Mat first = camera.render(kStart, 0.0).image, second = camera.render(kStart, 0.04).image;
  for (const auto& [other, expected] : {std::pair(clean, 3.0), std::pair(second, 3.0 * std::sqrt(2.0))}) {
    cv::Mat difference;
    cv::subtract(first, other, difference, cv::noArray(), CV_32F);
    const cv::Mat middle = difference(cv::Rect(100, 70, 120, 100)).clone().reshape(1);
    EXPECT_NEAR(cv::norm(middle) / std::sqrt(static_cast<double>(middle.total())), expected, 0.15 * expected);
  }
}

TEST(ScopeCamera, GetsDarkerWithDistanceWithoutAutomaticExposureAndNotWithIt) {
  SceneConfig config = small();
  const Eigen::Isometry3d farther(Eigen::Translation3d(0.0, 0.0, -0.08));
  config.exposure.automatic = false;
  ScopeCamera fixed = make(config);
  const double near = brightness(fixed.render(kStart, 0.0).image);
  EXPECT_NEAR(brightness(fixed.render(farther, 0.04).image), near / 4.0, 0.15 * near);
  config.exposure.automatic = true;
  ScopeCamera automatic = make(config);
  automatic.render(kStart, 0.0);
  automatic.render(farther, 0.0);
  EXPECT_NEAR(brightness(automatic.render(farther, 100.0).image), config.exposure.target, 5.0);
}

TEST(ScopeCamera, TheMaskSaysWhatTheInstrumentCovers) {
  SceneConfig config = small();
  config.camera.noise = 0.0;
  config.exposure.automatic = false;
  ScopeCamera camera = make(config);
  const cv::Mat without = camera.render(kStart, 0.0).image;
  const RenderedImage with = camera.render(kStart, 0.04, Eigen::Vector3d(0.0, 0.0, -0.02));
  ASSERT_EQ(with.instrument_mask.size(), without.size());
  EXPECT_GT(cv::countNonZero(with.instrument_mask), 500);
  cv::Mat difference, changed, outside;
  cv::absdiff(with.image, without, difference);
  cv::cvtColor(difference, changed, cv::COLOR_BGR2GRAY);
  cv::dilate(with.instrument_mask, outside, cv::Mat(), cv::Point(-1, -1), 2);
  EXPECT_EQ(cv::countNonZero((changed > 0) & ~outside), 0);
  EXPECT_GT(cv::countNonZero((changed > 0) & with.instrument_mask), 0.98 * cv::countNonZero(with.instrument_mask));
  EXPECT_TRUE(camera.render(kStart, 0.08).instrument_mask.empty());
}

// The scene's width is that of any texture, which may be replaced.
TEST(ScopeCamera, ShowsTheTextureThatItIsGiven) {
  SceneConfig config = small();
  config.camera.noise = 0.0;
  config.exposure.automatic = false;
  cv::Mat texture(300, 600, CV_8UC3, cv::Scalar(40, 80, 120));
  ScopeCamera camera(config, texture, placeTissue(config.tissue, kStart));
  EXPECT_EQ(camera.render(kStart, 0.0).image.at<cv::Vec3b>(120, 160), cv::Vec3b(40, 80, 120));
  texture.setTo(cv::Scalar(90, 30, 60));
  camera.setTexture(texture);
  EXPECT_EQ(camera.render(kStart, 0.04).image.at<cv::Vec3b>(120, 160), cv::Vec3b(90, 30, 60));
  EXPECT_THROW(camera.setTexture(cv::Mat()), std::invalid_argument);
}

TEST(ScopeCamera, RefusesAWrongConfigurationNamingEachError) {
  SceneConfig config = small();
  config.camera.rate = 0.0;
  config.tissue.width = -1.0;
  try {
    make(config);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("camera/rate"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("tissue/width"), std::string::npos);
  }
  config = small();
  config.tissue.image = "/there/is/no/such/file.png";
  EXPECT_THROW(make(config), std::runtime_error);
}

}  // namespace
}  // namespace laparoscope_servo::sim
