#include "tracking/align/texture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace laparoscope_servo::tracking {

namespace {

constexpr int kBlock = 16;  // px, over which noise and energy are averaged
constexpr double kQuartile = 0.25;
// Of the energy that noise has on average. In 16 x 16 px it has up to 1.3 times as much, and the lower quartile
// underestimates it by a sixth at most (20 planes of noise: see texture_test).
constexpr double kByChance = 1.6;

}  // namespace

double noiseOf(const cv::Mat1f& plane, const cv::Mat& mask) {
  if (plane.rows < 3 || plane.cols < 3) return 0.0;
  // The difference of two Laplacians, whose response to white noise is 6 times its standard deviation.
  const cv::Matx33f kernel(1, -2, 1, -2, 4, -2, 1, -2, 1);
  cv::Mat1f response;
  cv::filter2D(plane, response, CV_32F, kernel);
  response = cv::abs(response(cv::Rect(1, 1, plane.cols - 2, plane.rows - 2)));
  std::vector<double> blocks;
  for (int y = 0; y == 0 || y + kBlock <= response.rows; y += kBlock) {
    for (int x = 0; x == 0 || x + kBlock <= response.cols; x += kBlock) {
      const cv::Rect box = cv::Rect(x, y, kBlock, kBlock) & cv::Rect(cv::Point(0, 0), response.size());
      const cv::Rect seen(box.x, box.y, box.width + 2, box.height + 2);  // px of the plane, that the filter takes in
      if (mask.empty() || cv::countNonZero(mask(seen)) == 0) blocks.push_back(cv::mean(response(box))[0]);
    }
  }
  if (blocks.empty()) return noiseOf(plane);
  const auto quartile = blocks.begin() + static_cast<std::ptrdiff_t>(kQuartile * (blocks.size() - 1));
  std::nth_element(blocks.begin(), quartile, blocks.end());
  return std::sqrt(M_PI / 2.0) / 6.0 * *quartile;
}

cv::Mat1f textureShare(const cv::Mat1f& plane, double noise) {
  cv::Mat1f dx, dy, energy;
  cv::Sobel(plane, dx, CV_32F, 1, 0, 1, 0.5);
  cv::Sobel(plane, dy, CV_32F, 0, 1, 1, 0.5);
  cv::boxFilter(dx.mul(dx) + dy.mul(dy), energy, CV_32F, cv::Size(kBlock, kBlock));
  const double chance = kByChance * noise;
  cv::Mat1f share(plane.size());
  std::transform(energy.begin(), energy.end(), share.begin(), [&](float e) {
    return chance > 0.0 ? static_cast<float>(std::max(0.0, 1.0 - chance / std::max<double>(e, 1e-12))) : 1.0f;
  });
  return share;
}

}  // namespace laparoscope_servo::tracking
