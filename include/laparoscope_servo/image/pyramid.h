// A pyramid of one channel around a region of an image.
//
// Level l is 2^l times as coarse as the image. The centre of its pixel (0, 0) lies on the image's pixel origin(), so a point
// (u, v) of the image is ((u - origin.x) / 2^l, (v - origin.y) / 2^l) at level l.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

namespace laparoscope_servo::image {

// What blue, green and red weigh in the one channel that is tracked. BT.601 luma by default.
using ChannelWeights = std::array<float, 3>;
constexpr ChannelWeights kLuma = {0.114f, 0.587f, 0.299f};

class RegionPyramid {
 public:
  // `image` is CV_8UC1 (weights are ignored) or CV_8UC3, blue first. `region` is cut to the image; it must then hold at least
  // one pixel, else std::invalid_argument. Buffers are kept from one call to the next.
  void build(const cv::Mat& image, const cv::Rect& region, int levels, const ChannelWeights& weights);

  int levels() const { return static_cast<int>(levels_.size()); }
  const cv::Mat1f& level(int l) const { return levels_[l]; }
  cv::Point origin() const { return region_.tl(); }
  const cv::Rect& region() const { return region_; }

 private:
  cv::Rect region_;
  std::vector<cv::Mat1f> levels_;
};

}  // namespace laparoscope_servo::image
