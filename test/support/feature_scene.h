// A picture with a dot, a disc and the border of a half plane, as messages and as selections.
#pragma once

#include <cv_bridge/cv_bridge.h>

#include <functional>
#include <opencv2/core.hpp>
#include <string>

#include "support/synthetic_edges.h"

namespace laparoscope_servo::test_support {

constexpr char kDotsSelection[] = "[{id: large, point: [90, 120]}, {id: small, point: [90, 50]}]";
// In the small disc, which the windows around them hold nearly whole.
constexpr char kPointsSelection[] = "[{id: middle, point: [90, 50]}, {id: beside, point: [92, 51]}]";
constexpr char kEdgesSelection[] =
    "[{id: border, line: [[221, 30], [219, 200]]},"
    " {id: rim, ellipse: {centre: [90, 120], radii: [26, 22], angle: 0.3}}]";

// `shift` px to the right; `seed` of the noise: no two pictures repeat.
inline cv::Mat featureScene(double shift, unsigned seed, const std::function<void(cv::Mat1f&)>& cover = nullptr) {
  const Eigen::Vector2d by(shift, 0.0);
  const test::Region disc = test::ellipse(Eigen::Vector2d(90.0, 120.0) + by, 25.0, 22.0, 0.3),
                     small = test::ellipse(Eigen::Vector2d(90.0, 50.0) + by, 9.0, 9.0, 0.0),
                     half = test::halfPlane(220.0 + shift, 0.0);
  test::EdgeScene drawn;
  drawn.seed = seed;
  return test::draw(
      drawn, [&](const Eigen::Vector2d& p) { return disc(p) || small(p) || half(p); }, cover);
}

inline cv::Mat coveredScene(unsigned seed) {
  return featureScene(0.0, seed, [](cv::Mat1f& pixels) { pixels.setTo(100.0f); });
}

inline sensor_msgs::ImagePtr imageAt(const cv::Mat& image, double seconds) {
  std_msgs::Header header;
  header.stamp = ros::Time(seconds);
  header.frame_id = "optical_of_the_test";
  return cv_bridge::CvImage(header, image.channels() == 1 ? "mono8" : "bgr8", image).toImageMsg();
}

}  // namespace laparoscope_servo::test_support
