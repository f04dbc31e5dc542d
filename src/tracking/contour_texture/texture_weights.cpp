#include "tracking/contour_texture/texture_weights.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "laparoscope_servo/image/pyramid.h"
#include "tracking/align/texture.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr double kInset = 2.0;  // px of the level: what lies nearer to the contour is what smoothing takes from outside
constexpr int kAround = 17;     // px, over which what is inside is taken to go on beyond the contour

}  // namespace

cv::Mat1b insideOf(const std::vector<Eigen::Vector2d>& points, const cv::Rect& box, int scale) {
  std::vector<cv::Point> polygon;
  for (const Eigen::Vector2d& p : points)
    polygon.emplace_back(static_cast<int>(std::lround(p.x())) - box.x, static_cast<int>(std::lround(p.y())) - box.y);
  const int inset = static_cast<int>(std::ceil(kInset * scale));
  cv::Mat1b inside = cv::Mat1b::zeros(box.height, box.width);
  cv::fillPoly(inside, std::vector<std::vector<cv::Point>>{polygon}, 255);
  cv::erode(inside, inside, cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * inset + 1, 2 * inset + 1}), {-1, -1}, 1,
            cv::BORDER_CONSTANT, 0);
  return inside;
}

TextureWeights textureWeights(const cv::Mat& image, const cv::Mat1b& inside, const cv::Mat1f& level, int scale) {
  cv::Mat grey = image;
  if (image.channels() == 3) cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  cv::Mat1f pixels;
  grey.convertTo(pixels, CV_32F);
  const image::LevelNoise left = image::levelNoise(scale);
  const double noise = noiseOf(pixels);
  TextureWeights result;
  result.noise = std::max(1.0, left.deviation * noise);
  cv::Mat1f weights, mean, share;
  inside.convertTo(weights, CV_32F, 1.0 / 255.0);
  cv::resize(weights, weights, level.size(), 0, 0, cv::INTER_AREA);
  // Outside of the contour stands what is inside near it, so that the contour itself is no texture.
  cv::Mat1f filled = level.clone();
  cv::boxFilter(level.mul(weights), mean, CV_32F, {kAround, kAround}, {-1, -1}, true, cv::BORDER_CONSTANT);
  cv::boxFilter(weights, share, CV_32F, {kAround, kAround}, {-1, -1}, true, cv::BORDER_CONSTANT);
  cv::Mat(mean / (share + 1e-6f)).copyTo(filled, weights < 1.0f);
  result.weights = weights.mul(textureShare(filled, left.gradient * noise * noise));
  return result;
}

}  // namespace laparoscope_servo::tracking
