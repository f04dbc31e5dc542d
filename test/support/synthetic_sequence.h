// Images with known motion for tests: a smooth random texture in colour, seen through homographies.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::test_support {

// 8UC3, the same for the same seed, with structure from about 4 px up.
inline cv::Mat texture(const cv::Size& size, std::uint64_t seed = 1) {
  cv::RNG random(seed);
  cv::Mat sum = cv::Mat::zeros(size, CV_32FC3);
  for (const double scale : {4.0, 10.0, 25.0}) {
    cv::Mat noise(size, CV_32FC3);
    random.fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
    cv::GaussianBlur(noise, noise, cv::Size(), scale / 2.0, scale / 2.0, cv::BORDER_REFLECT_101);
    sum += noise * scale;  // about the same contrast at each scale
  }
  cv::Mat image;
  // Reddish, as tissue is: the channels differ in level and contrast.
  cv::multiply(sum, cv::Scalar(10.0, 12.0, 16.0), sum);
  sum += cv::Scalar(90.0, 100.0, 150.0);
  sum.convertTo(image, CV_8UC3);
  return image;
}

// `reference` as it looks after g, which takes pixels of the reference image to pixels of the result.
inline cv::Mat view(const cv::Mat& reference, const Eigen::Matrix3d& g) {
  cv::Matx33d warp;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) warp(row, column) = g(row, column);
  }
  cv::Mat image;
  cv::warpPerspective(reference, image, warp, reference.size(), cv::INTER_CUBIC, cv::BORDER_REFLECT_101);
  return image;
}

// As a camera sees it: with noise of one grey level, by which no two pictures are the same.
inline cv::Mat noisy(const cv::Mat& image, cv::RNG& random) {
  cv::Mat noise(image.size(), image.type());
  random.fill(noise, cv::RNG::UNIFORM, 0, 2);
  return noise + image;
}

// A slow closed motion of the corners of `roi`, starting at the identity: n homographies with determinant 1, up to
// `amplitude` px in every corner.
inline std::vector<Eigen::Matrix3d> motion(int n, const geometry::Rectangle& roi, double amplitude) {
  std::vector<Eigen::Matrix3d> result;
  const geometry::Quadrilateral corners = roi.corners();
  for (int k = 0; k < n; ++k) {
    const double phase = 2.0 * M_PI * k / n;
    geometry::Quadrilateral moved = corners;
    for (int c = 0; c < 4; ++c) {
      moved[c] += amplitude * Eigen::Vector2d(std::sin(phase + 0.2 * c) - std::sin(0.2 * c),
                                              0.5 * (std::cos(phase - 0.1 * c) - std::cos(0.1 * c)));
    }
    result.push_back(geometry::fromCorners(corners, moved));
  }
  return result;
}

}  // namespace laparoscope_servo::test_support
