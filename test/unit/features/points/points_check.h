// Points on drawn tissue that moves as the tests want it to.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "laparoscope_servo/features/points.h"
#include "laparoscope_servo/geometry/homography.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::features {

constexpr double kPeriod = 0.04;  // s
const cv::Size kSize(320, 240);

// About the middle of the image.
inline Eigen::Matrix3d motion(const Eigen::Vector2d& shift, double turn = 0.0, double scale = 1.0) {
  const Eigen::Vector2d middle(160.0, 120.0);
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topLeftCorner<2, 2>() = scale * Eigen::Rotation2Dd(turn).toRotationMatrix();
  g.topRightCorner<2, 1>() = middle + shift - g.topLeftCorner<2, 2>() * middle;
  return g;
}

class PointsTest : public testing::Test {
 protected:
  static cv::Mat image(const Eigen::Matrix3d& g, double gain = 1.0, double bias = 0.0) {
    static unsigned seed = 0;
    return test::view(scene(), g, gain, bias, 1.5, ++seed);
  }
  static const cv::Mat& scene() {
    static const cv::Mat scene = test::tissue(kSize, 21);
    return scene;
  }

  void select(const cv::Rect& region = {70, 50, 180, 140}, int count = 20) {
    const cv::Mat first = image(Eigen::Matrix3d::Identity());
    corners_ = findCorners(first, region, count, {});
    ASSERT_GE(corners_.size(), 8u);
    tracker_.select(first, 0.0, {{cv::Mat(), corners_}});
    time_ = 0.0;
  }
  const PointsResult& track(const cv::Mat& next, double period = kPeriod) {
    return tracker_.track(next, time_ += period);
  }
  // Of those that are TRACKING: the worst error, px.
  double worst(const Eigen::Matrix3d& g) const {
    double result = 0.0;
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      const PointResult& point = tracker_.result().points[k];
      if (point.state == State::kTracking)
        result = std::max(result, (point.place - geometry::apply(g, corners_[k])).norm());
    }
    return result;
  }
  std::size_t tracking() const {
    std::size_t count = 0;
    for (const PointResult& point : tracker_.result().points) count += point.state == State::kTracking ? 1 : 0;
    return count;
  }

  PointTracker tracker_;
  std::vector<Eigen::Vector2d> corners_;
  double time_ = 0.0;
};

}  // namespace laparoscope_servo::features
