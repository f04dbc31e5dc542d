// An object that slides over the tissue of the simulated scope: a piece of the tissue's own texture.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::bench {

// A piece of the texture that slides over it: to and fro, at 20 px/s where it is seen squarely.
class Slider {
 public:
  // `height`: m, of what the texture shows.
  Slider(const cv::Mat& texture, double height) : texture_(texture), texels_(texture.rows / height) {
    const cv::Size size(static_cast<int>(kWidth * texels_), static_cast<int>(kTall * texels_));
    texture(cv::Rect(cv::Point(0, 0), size)).copyTo(piece_);
  }
  // m, of its middle in the tissue's plane.
  Eigen::Vector2d middle(double time) const {
    const double way = std::fmod(kSpeed * time, 2.0 * kWay);
    return {-0.012 + (way < kWay ? way : 2.0 * kWay - way), -0.008};
  }
  cv::Mat texture(double time) const {
    const Eigen::Vector2d first = texels_ * (middle(time) - 0.5 * Eigen::Vector2d(kWidth, kTall)) +
                                  0.5 * Eigen::Vector2d(texture_.cols - 1.0, texture_.rows - 1.0);
    const cv::Matx23d shift(1.0, 0.0, first.x(), 0.0, 1.0, first.y());
    cv::Mat canvas = texture_.clone(), there, mask;
    cv::warpAffine(piece_, there, shift, canvas.size());
    cv::warpAffine(cv::Mat(piece_.size(), CV_8UC1, cv::Scalar(255)), mask, shift, canvas.size());
    there.copyTo(canvas, mask == 255);
    return canvas;
  }
  static geometry::Rectangle regionAbout(const Eigen::Vector2d& pixel, double focal_length, double distance) {
    const double width = std::floor(kWidth * focal_length / distance) - 4.0;
    const double height = std::floor(kTall * focal_length / distance) - 4.0;
    return {std::round(pixel.x() - 0.5 * width), std::round(pixel.y() - 0.5 * height), width, height};
  }

 private:
  static constexpr double kWidth = 0.035, kTall = 0.028;  // m: 8 % of the image
  static constexpr double kSpeed = 0.004, kWay = 0.014;   // m/s, m: 20 and 70 px
  cv::Mat texture_, piece_;
  double texels_;  // by m
};

}  // namespace laparoscope_servo::bench
