#include "laparoscope_servo/image/pyramid.h"

#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::image {

namespace {

LAPAROSCOPE_SERVO_CLONES
void weighRow(const unsigned char* __restrict from, int count, float b, float g, float r, float* __restrict to) {
  for (int u = 0; u < count; ++u) to[u] = b * from[3 * u] + g * from[3 * u + 1] + r * from[3 * u + 2];
}

void toOneChannel(const cv::Mat& image, const ChannelWeights& weights, cv::Mat1f& grey) {
  grey.create(image.size());
  if (image.type() == CV_8UC1) {
    image.convertTo(grey, CV_32F);
    return;
  }
  for (int v = 0; v < image.rows; ++v) {
    weighRow(image.ptr<unsigned char>(v), image.cols, weights[0], weights[1], weights[2], grey.ptr<float>(v));
  }
}

}  // namespace

void RegionPyramid::build(const cv::Mat& image, const cv::Rect& region, int levels, const ChannelWeights& weights) {
  if (image.type() != CV_8UC1 && image.type() != CV_8UC3) {
    throw std::invalid_argument("image of OpenCV type " + std::to_string(image.type()) +
                                ", expected 8 bit with one channel or three");
  }
  region_ = region & cv::Rect(0, 0, image.cols, image.rows);
  if (region_.empty() || levels < 1) {
    throw std::invalid_argument("region of interest holds no pixel of the image");
  }
  levels_.resize(levels);
  toOneChannel(image(region_), weights, levels_[0]);
  for (int l = 1; l < levels; ++l) cv::pyrDown(levels_[l - 1], levels_[l]);
}

}  // namespace laparoscope_servo::image
