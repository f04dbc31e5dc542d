#include "tracking/search/coarse_image.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::tracking {

namespace {

constexpr int kGrowBright = 3;  // px of the coarse image, by which saturated pixels are dilated

}  // namespace

int coarseScale(const cv::Size& image, int max_pixels) {
  return std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(image.area()) / max_pixels))));
}

cv::Mat1b oneChannel(const cv::Mat& image, const image::ChannelWeights& weights) {
  if (image.channels() == 1) return image;
  double low = 0.0;
  double high = 0.0;
  for (const float w : weights) (w < 0.0f ? low : high) += w;
  const double range = std::max(high - low, 1e-6);
  const cv::Matx14f mixture(static_cast<float>(weights[0] / range), static_cast<float>(weights[1] / range),
                            static_cast<float>(weights[2] / range), static_cast<float>(-255.0 * low / range));
  cv::Mat1b grey;
  cv::transform(image, grey, mixture);
  return grey;
}

CoarseImage coarseImage(const cv::Mat& image, int scale, const image::ChannelWeights& weights, int saturation) {
  CoarseImage result;
  result.scale = scale;
  const cv::Size size(image.cols / scale, image.rows / scale);
  if (size.empty()) return result;
  cv::Mat small;
  const cv::Rect whole(0, 0, size.width * scale, size.height * scale);
  cv::resize(image(whole), small, size, 0.0, 0.0, cv::INTER_AREA);
  cv::inRange(small, cv::Scalar::all(0), cv::Scalar::all(saturation - 1), result.usable);
  cv::erode(result.usable, result.usable, cv::Mat(), cv::Point(-1, -1), kGrowBright);
  result.grey = oneChannel(small, weights);
  return result;
}

}  // namespace laparoscope_servo::tracking
