// How much each pixel inside of a contour tells of its motion by its texture.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

namespace laparoscope_servo::tracking {

// 255 inside of the outline through `points`, px of the image, and far enough from it for the smoothing of a level of
// `scale` px of the image per px; else 0. Of the pixels of `box`.
cv::Mat1b insideOf(const std::vector<Eigen::Vector2d>& points, const cv::Rect& box, int scale);

struct TextureWeights {
  cv::Mat1f weights;   // 0 to 1, of the size of the level: share of a pixel that lies inside, times that of its texture
  double noise = 1.0;  // grey levels, standard deviation of that of the level; at least 1
};

// `image`: CV_8UC1 or CV_8UC3, `inside` of its size; `level`: what ESM's finest level has of it. Noise that were taken
// for texture would not drive the motion, but the gain, towards 0.
TextureWeights textureWeights(const cv::Mat& image, const cv::Mat1b& inside, const cv::Mat1f& level, int scale);

}  // namespace laparoscope_servo::tracking
