// An image as points are drawn from it: coarser, in one channel.
#pragma once

#include <opencv2/core.hpp>

#include "laparoscope_servo/image/pyramid.h"

namespace laparoscope_servo::tracking {

struct CoarseImage {
  cv::Mat1b grey;
  cv::Mat1b usable;  // 255, or 0 near what is saturated: highlights move with the lamp
  int scale = 1;     // px of the image per pixel

  // px of the image that the centre of a pixel lies at.
  cv::Point2f inImage(const cv::Point2f& pixel) const {
    const float size = static_cast<float>(scale);
    return {(pixel.x + 0.5f) * size - 0.5f, (pixel.y + 0.5f) * size - 0.5f};
  }
};

// Whole pixels of the image per pixel, as few as leave at most `max_pixels`: a whole factor is several times faster.
int coarseScale(const cv::Size& image, int max_pixels);

// `image` is CV_8UC1 (weights are ignored) or CV_8UC3; it is not kept. Pixels as bright as `saturation` in any channel
// are saturated. Rows and columns that fill no pixel are left away.
CoarseImage coarseImage(const cv::Mat& image, int scale, const image::ChannelWeights& weights, int saturation);

// One channel of 8 bits: the weights' mixture, brought into their range, which negative weights would leave.
cv::Mat1b oneChannel(const cv::Mat& image, const image::ChannelWeights& weights);

}  // namespace laparoscope_servo::tracking
