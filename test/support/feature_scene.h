// A picture with a dot, a disc, a piece of texture and the border of a half plane, as messages and as selections.
#pragma once

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/CameraInfo.h>

#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "support/synthetic_edges.h"

namespace laparoscope_servo::test_support {

constexpr char kDotsSelection[] = "[{id: large, point: [90, 120]}, {id: small, point: [90, 50]}]";
// In the texture.
constexpr char kPointsSelection[] = "[{id: middle, point: [165, 55]}, {id: beside, point: [172, 60]}]";
constexpr char kEdgesSelection[] =
    "[{id: border, line: [[221, 30], [219, 200]]},"
    " {id: rim, ellipse: {centre: [90, 120], radii: [26, 22], angle: 0.3}}]";

// Smooth texture from (140, 30) to (190, 80), moved by `shift` px to the right.
inline void addTexture(cv::Mat1f& pixels, double shift) {
  constexpr int kSide = 50, kMargin = 20;
  cv::Mat1f texture(kSide + 2 * kMargin, kSide + 2 * kMargin), moved;
  cv::RNG(11).fill(texture, cv::RNG::NORMAL, 0.0, 200.0);
  cv::GaussianBlur(texture, texture, cv::Size(), 2.0);
  const int whole = static_cast<int>(std::floor(shift));
  const double part = shift - whole;
  cv::getRectSubPix(texture, {kSide, kSide},
                    {static_cast<float>(0.5 * (texture.cols - 1) - part), 0.5f * static_cast<float>(texture.rows - 1)},
                    moved);
  pixels(cv::Rect(140 + whole, 30, kSide, kSide)) += moved;
}

// `shift` px to the right; `seed` of the noise: no two pictures repeat.
inline cv::Mat featureScene(double shift, unsigned seed, const std::function<void(cv::Mat1f&)>& cover = nullptr) {
  const Eigen::Vector2d by(shift, 0.0);
  const test::Region disc = test::ellipse(Eigen::Vector2d(90.0, 120.0) + by, 25.0, 22.0, 0.3),
                     small = test::ellipse(Eigen::Vector2d(90.0, 50.0) + by, 9.0, 9.0, 0.0),
                     half = test::halfPlane(220.0 + shift, 0.0);
  test::EdgeScene drawn;
  drawn.seed = seed;
  return test::draw(
      drawn, [&](const Eigen::Vector2d& p) { return disc(p) || small(p) || half(p); },
      [&](cv::Mat1f& pixels) {
        addTexture(pixels, shift);
        if (cover) cover(pixels);
      });
}

inline cv::Mat coveredScene(unsigned seed) {
  return featureScene(0.0, seed, [](cv::Mat1f& pixels) { pixels.setTo(100.0f); });
}

// Of a camera of its pictures, 320 x 240 px.
inline sensor_msgs::CameraInfo featureCamera() {
  sensor_msgs::CameraInfo info;
  info.width = 320;
  info.height = 240;
  info.K = {300.0, 0.0, 160.0, 0.0, 300.0, 120.0, 0.0, 0.0, 1.0};
  return info;
}

inline sensor_msgs::ImagePtr imageAt(const cv::Mat& image, double seconds) {
  std_msgs::Header header;
  header.stamp = ros::Time(seconds);
  header.frame_id = "optical_of_the_test";
  return cv_bridge::CvImage(header, image.channels() == 1 ? "mono8" : "bgr8", image).toImageMsg();
}

}  // namespace laparoscope_servo::test_support
