// A coarse image in one channel, in which points are detected.
#pragma once

#include <opencv2/core.hpp>

#include "laparoscope_servo/image/pyramid.h"

namespace laparoscope_servo::tracking {

struct CoarseImage {
  cv::Mat1b grey;
  cv::Mat1b usable;  // 255, or 0 near saturated pixels, since highlights move with the lamp
  int scale = 1;     // px of the image per px of the coarse one

  // Place of a coarse pixel's centre in the image [px].
  cv::Point2f inImage(const cv::Point2f& pixel) const {
    const float size = static_cast<float>(scale);
    return {(pixel.x + 0.5f) * size - 0.5f, (pixel.y + 0.5f) * size - 0.5f};
  }
};

// The smallest whole factor by which to reduce the image to at most `max_pixels`. Whole factors are several times
// faster.
int coarseScale(const cv::Size& image, int max_pixels);

// `image` is CV_8UC1 (weights are ignored) or CV_8UC3; it is not kept. Pixels as bright as `saturation` in any channel
// are saturated. Remaining rows and columns that do not fill a coarse pixel are dropped.
CoarseImage coarseImage(const cv::Mat& image, int scale, const image::ChannelWeights& weights, int saturation);

// The weighted sum of the channels in 8 bits, shifted and scaled into their range, which negative weights would leave.
cv::Mat1b oneChannel(const cv::Mat& image, const image::ChannelWeights& weights);

}  // namespace laparoscope_servo::tracking
