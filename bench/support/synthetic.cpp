#include "bench/support/synthetic.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::bench {

cv::Mat syntheticTissue(const cv::Size& size, unsigned seed) {
  cv::RNG random(seed + 1);
  cv::Mat1f height(size, 0.0f);
  for (const double scale : {1.5, 4.0, 12.0, 40.0}) {
    cv::Mat1f noise(size), smooth;
    random.fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
    cv::GaussianBlur(noise, smooth, cv::Size(), scale);
    height += smooth * (scale * 2.0 * std::sqrt(3.14159265358979));  // each scale alike
  }
  cv::Mat channels[3];
  height.convertTo(channels[0], CV_8U, 11.0, 75.0);
  height.convertTo(channels[1], CV_8U, 14.0, 85.0);
  height.convertTo(channels[2], CV_8U, 17.0, 150.0);
  cv::Mat image;
  cv::merge(channels, 3, image);
  return image;
}

cv::Mat view(const cv::Mat& image, const Eigen::Matrix3d& g, double noise, std::mt19937& random) {
  cv::Matx33d warp;
  for (int k = 0; k < 9; ++k) warp(k / 3, k % 3) = g(k / 3, k % 3);
  cv::Mat seen;
  cv::warpPerspective(image, seen, warp, image.size(), cv::INTER_CUBIC, cv::BORDER_REFLECT);
  if (noise > 0.0) {
    cv::RNG rng(random());
    cv::Mat grain(seen.size(), CV_MAKETYPE(CV_16S, seen.channels()));
    rng.fill(grain, cv::RNG::NORMAL, 0.0, noise);
    cv::add(seen, grain, seen, cv::noArray(), CV_8U);
  }
  return seen;
}

Eigen::Matrix3d displacedCorners(const geometry::Rectangle& roi, double sigma, std::mt19937& random) {
  std::normal_distribution<double> normal(0.0, sigma);
  for (;;) {
    geometry::Quadrilateral corners = roi.corners();
    for (Eigen::Vector2d& corner : corners) {
      corner.x() += normal(random);
      corner.y() += normal(random);
    }
    if (geometry::isConvex(corners)) return geometry::fromCorners(roi.corners(), corners);
  }
}

Eigen::Matrix3d displaced(double distance, std::mt19937& random) {
  const double angle = std::uniform_real_distribution<double>(0.0, 2.0 * 3.14159265358979)(random);
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m.topRightCorner<2, 1>() << distance * std::cos(angle), distance * std::sin(angle);
  return m;
}

geometry::Rectangle middle(const geometry::Rectangle& roi, double side) {
  const double s = std::min({side, roi.width, roi.height});
  return {std::floor(roi.x + (roi.width - s) / 2.0), std::floor(roi.y + (roi.height - s) / 2.0), s, s};
}

}  // namespace laparoscope_servo::bench
