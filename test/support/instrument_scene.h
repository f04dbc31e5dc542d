// A grey shaft that enters from the left in front of red tissue.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "support/synthetic_edges.h"

namespace laparoscope_servo::test_support {

// The shaft's axis, px: where it leaves the picture, and its tip, both moved by `shift`.
inline Eigen::Vector2d shaftTip(double shift) {
  return {200.0 + shift, 150.0 + 0.5 * shift};
}

constexpr double kShaftHalfWidth = 16.0;  // px

// CV_8UC3, 320x240; `seed`: of the noise. Without the shaft where `empty`.
inline cv::Mat instrumentScene(double shift, unsigned seed, bool empty = false) {
  const cv::Size size(320, 240);
  const cv::Mat1f tissue = test::texture(size, 0.0, 10.0, 4.0, 3);
  const Eigen::Vector2d tip = shaftTip(shift), direction = Eigen::Vector2d(0.9, 0.35).normalized(),
                        across(-direction.y(), direction.x());
  const cv::Mat1f inside = empty ? cv::Mat1f(size, 0.0f) : test::coverage(size, [&](const Eigen::Vector2d& p) {
    return direction.dot(p - tip) < 0.0 && std::abs(across.dot(p - tip)) < kShaftHalfWidth;
  });
  cv::RNG random(seed);
  std::vector<cv::Mat1f> channels;
  for (const double level : {60.0, 75.0, 165.0}) {
    cv::Mat1f channel = tissue + level;
    channel = channel.mul(1.0f - inside) + 45.0f * inside;
    cv::GaussianBlur(channel, channel, cv::Size(), 0.9);
    cv::Mat1f noise(size);
    random.fill(noise, cv::RNG::NORMAL, 0.0, 2.0);
    channels.push_back(channel + noise);
  }
  cv::Mat image;
  cv::merge(std::vector<cv::Mat>(channels.begin(), channels.end()), image);
  image.convertTo(image, CV_8UC3);
  return image;
}

}  // namespace laparoscope_servo::test_support
