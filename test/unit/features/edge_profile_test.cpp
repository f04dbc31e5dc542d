#include "laparoscope_servo/features/edge_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::features {
namespace {

Site siteAt(double x, double y, double theta) {
  Site site;
  site.point = {x, y};
  site.normal = {std::cos(theta), std::sin(theta)};
  return site;
}

// Grey levels 10 + x + y: bilinear samples are exact, and the mean across is the level on the normal.
cv::Mat ramp(int columns, int rows) {
  cv::Mat image(rows, columns, CV_8UC1);
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < columns; ++u) image.at<unsigned char>(v, u) = static_cast<unsigned char>(10 + u + v);
  }
  return image;
}

double levelAt(const EdgeProfile& profile, int k) {
  return static_cast<double>(profile.levels()[k - profile.first()]);
}

TEST(EdgeProfile, readsTheLevelsAlongTheNormal) {
  const cv::Mat image = ramp(100, 80);
  cv::Mat colour;
  cv::cvtColor(image, colour, cv::COLOR_GRAY2BGR);
  for (const double step : {1.0, 2.0}) {
    for (const int stride : {1, 2}) {
      for (double theta = -3.1; theta < 3.2; theta += 0.3) {
        const Site site = siteAt(50.3, 40.6, theta);
        EdgeProfile grey, luma;
        ASSERT_TRUE(grey.read(image, site, {12.0, step, stride}));
        ASSERT_TRUE(luma.read(colour, site, {12.0, step, stride}));
        EXPECT_LE(grey.first(), -12.0 / step - EdgeProfile::kReach);
        EXPECT_GE(grey.first() + grey.count() - 1, 12.0 / step + EdgeProfile::kReach);
        for (int k = grey.first(); k < grey.first() + grey.count(); ++k) {
          const Eigen::Vector2d p = site.point + k * step * site.normal;
          EXPECT_NEAR(levelAt(grey, k), 10.0 + p.x() + p.y(), 1e-3);
          EXPECT_NEAR(levelAt(luma, k), levelAt(grey, k), 1e-2);
        }
      }
    }
  }
}

TEST(EdgeProfile, averagesAcrossTheNormal) {
  // A line of one bright pixel along x: a fifth of a mask of five rows across it, a third of one of every other row.
  cv::Mat image = cv::Mat::zeros(60, 60, CV_8UC1);
  image.row(30).setTo(150);
  EdgeProfile profile;
  ASSERT_TRUE(profile.read(image, siteAt(30.0, 30.0, 0.0), {10.0, 1.0, 1}));
  EXPECT_NEAR(levelAt(profile, 0), 30.0, 1e-3);
  ASSERT_TRUE(profile.read(image, siteAt(30.0, 30.0, 0.0), {10.0, 1.0, 2}));
  EXPECT_NEAR(levelAt(profile, 0), 50.0, 1e-3);
  ASSERT_TRUE(profile.read(image, siteAt(30.0, 30.0, 0.5 * M_PI), {10.0, 1.0, 1}));
  EXPECT_NEAR(levelAt(profile, 0), 150.0, 1e-3);
  EXPECT_NEAR(levelAt(profile, 1), 0.0, 1e-3);
}

TEST(EdgeProfile, endsAtTheImagesBorder) {
  const cv::Mat image(60, 100, CV_8UC1, cv::Scalar(80));
  EdgeProfile profile;
  ASSERT_TRUE(profile.read(image, siteAt(5.5, 30.0, 0.0), {20.0, 1.0, 1}));
  EXPECT_EQ(profile.first(), -5);
  EXPECT_GE(profile.first() + profile.count() - 1, 22);
  for (int k = 0; k < profile.count(); ++k) EXPECT_NEAR(profile.levels()[k], 80.0f, 1e-3f);
  // Too near for the mask; outside; the samples across would be.
  EXPECT_FALSE(profile.read(image, siteAt(1.5, 30.0, 0.0), {20.0, 1.0, 1}));
  EXPECT_FALSE(profile.read(image, siteAt(-30.0, 30.0, 0.0), {20.0, 1.0, 1}));
  EXPECT_FALSE(profile.read(image, siteAt(50.0, 1.0, 0.0), {20.0, 1.0, 1}));
  // A part of a larger image: rows are further apart than they are long.
  const cv::Mat part = ramp(100, 80)(cv::Rect(20, 16, 60, 40));
  ASSERT_TRUE(profile.read(part, siteAt(30.0, 20.0, 0.0), {5.0, 1.0, 1}));
  for (int k = -5; k <= 5; ++k) EXPECT_NEAR(levelAt(profile, k), 10.0 + 50.0 + 36.0 + k, 1e-3);
}

// A curve that a motion has carried away has sites that fit no int, or are nowhere.
TEST(EdgeProfile, readsNothingWhereASiteIsFarOutOrNowhere) {
  const cv::Mat image = ramp(100, 80);
  const double infinite = std::numeric_limits<double>::infinity();
  EdgeProfile profile;
  for (const double wrong : {std::nan(""), infinite, -infinite, 1e9, -1e9, 1e12, 1e200, -1e200}) {
    for (const double theta : {0.0, 0.7, 0.5 * M_PI}) {
      EXPECT_FALSE(profile.read(image, siteAt(wrong, 40.0, theta), {12.0, 1.0, 1})) << wrong;
      EXPECT_FALSE(profile.read(image, siteAt(50.0, wrong, theta), {12.0, 1.0, 1})) << wrong;
      EXPECT_FALSE(profile.read(image, siteAt(wrong, wrong, theta), {12.0, 1.0, 1})) << wrong;
    }
  }
  EXPECT_FALSE(profile.read(image, siteAt(50.0, 40.0, std::nan("")), {12.0, 1.0, 1}));
}

}  // namespace
}  // namespace laparoscope_servo::features
