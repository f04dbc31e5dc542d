#include "laparoscope_servo/sim/instrument.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::sim {
namespace {

const geometry::PinholeCamera kCamera{400.0, 400.0, 320.0, 240.0};
const cv::Size kSize(641, 481);
const cv::Vec3b kBackground(10, 200, 30);

class DrawCapsules : public testing::Test {
 protected:
  void draw(const std::vector<Capsule>& capsules) {
    image_ = cv::Mat(kSize, CV_8UC3, cv::Scalar(kBackground[0], kBackground[1], kBackground[2]));
    drawCapsules(capsules, kCamera, Lamp(LightConfig(), kCamera, kSize, 0.0), 1.0, image_, mask_);
  }
  bool masked(int u, int v) const { return mask_.at<uchar>(v, u) == 255; }

  cv::Mat image_, mask_;
};

Capsule sphere(const Eigen::Vector3d& centre, double radius) {
  return {centre, centre, radius, {50.0F, 60.0F, 70.0F}};
}

TEST_F(DrawCapsules, SphereOnTheAxisIsADiscOfItsTangentCone) {
  draw({sphere({0.0, 0.0, 0.05}, 0.01)});
  const double radius = 400.0 * std::tan(std::asin(0.01 / 0.05));
  for (int v = 0; v < kSize.height; ++v) {
    for (int u = 0; u < kSize.width; ++u) {
      const double distance = std::hypot(u - 320.0, v - 240.0);
      if (std::abs(distance - radius) > 1.0) {
        EXPECT_EQ(masked(u, v), distance < radius) << u << ", " << v;
      }
    }
  }
}

TEST_F(DrawCapsules, CylinderCoversTheRaysThatMeetIt) {
  // Along y at z = 0.06: |x| <= tan(asin(r / z)) z in every row that it reaches.
  draw({{{0.0, -0.1, 0.06}, {0.0, 0.1, 0.06}, 0.003, {50.0F, 60.0F, 70.0F}}});
  const double half_width = 400.0 * std::tan(std::asin(0.003 / 0.06));
  for (const int v : {0, 100, 240, 480}) {
    for (int u = 0; u < kSize.width; ++u) {
      if (std::abs(std::abs(u - 320.0) - half_width) > 1.0) {
        EXPECT_EQ(masked(u, v), std::abs(u - 320.0) < half_width);
      }
    }
  }
}

TEST_F(DrawCapsules, PixelsOutsideTheMaskKeepTheirColourButForTheEdge) {
  draw({sphere({0.01, -0.01, 0.05}, 0.008), {{0.02, 0.0, 0.06}, {0.1, 0.08, 0.02}, 0.003, {50.0F, 60.0F, 70.0F}}});
  cv::Mat far_from_mask;
  cv::dilate(mask_, far_from_mask, cv::Mat(), cv::Point(-1, -1), 2);
  ASSERT_GT(cv::countNonZero(mask_), 1000);
  int changed_inside = 0;
  for (int v = 0; v < kSize.height; ++v) {
    for (int u = 0; u < kSize.width; ++u) {
      const auto& pixel = image_.at<cv::Vec3b>(v, u);
      if (far_from_mask.at<uchar>(v, u) == 0) {
        EXPECT_EQ(pixel, kBackground);
      }
      changed_inside += mask_.at<uchar>(v, u) != 0 && pixel != kBackground;
    }
  }
  EXPECT_EQ(changed_inside, cv::countNonZero(mask_));
}

TEST_F(DrawCapsules, TheNearerCoversTheFartherInEitherOrder) {
  const Capsule near{{0.0, 0.0, 0.04}, {0.0, 0.0, 0.04}, 0.004, {200.0F, 0.0F, 0.0F}};
  const Capsule far{{0.0, 0.0, 0.06}, {0.0, 0.0, 0.06}, 0.010, {0.0F, 0.0F, 200.0F}};
  draw({near, far});
  const cv::Vec3b first = image_.at<cv::Vec3b>(240, 300);
  draw({far, near});
  EXPECT_EQ(image_.at<cv::Vec3b>(240, 300), first);
  EXPECT_GT(first[0], first[2]);
}

TEST_F(DrawCapsules, NothingBehindTheCameraAndNoTroubleThroughItsPlane) {
  draw({sphere({0.0, 0.0, -0.05}, 0.01)});
  EXPECT_EQ(cv::countNonZero(mask_), 0);
  draw({{{0.02, 0.02, 0.06}, {0.05, 0.05, -0.2}, 0.003, {50.0F, 60.0F, 70.0F}}});
  EXPECT_GT(cv::countNonZero(mask_), 100);
  EXPECT_LT(cv::countNonZero(mask_), kSize.area() / 2);
}

TEST(InstrumentTip, RunsFromStartToEndOnce) {
  InstrumentConfig config;
  config.crossing_time = 2.0;
  EXPECT_FALSE(instrumentTip(config, -0.01));
  EXPECT_FALSE(instrumentTip(config, 2.01));
  EXPECT_FALSE(instrumentTip(config, std::nan("")));
  EXPECT_TRUE(instrumentTip(config, 0.0)->isApprox(config.start));
  EXPECT_TRUE(instrumentTip(config, 1.0)->isApprox((config.start + config.end) / 2.0));
  EXPECT_TRUE(instrumentTip(config, 2.0)->isApprox(config.end));
}

TEST(InstrumentAt, ReachesFromTheTipToTheTrocar) {
  const InstrumentConfig config;
  const Eigen::Vector3d tip(0.01, 0.0, -0.02);
  const std::vector<Capsule> capsules = instrumentAt(config, tip);
  EXPECT_TRUE(capsules.front().a.isApprox(tip));
  EXPECT_TRUE(capsules.back().b.isApprox(config.trocar));
}

}  // namespace
}  // namespace laparoscope_servo::sim
