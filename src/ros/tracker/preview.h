// A small picture for people, on ~preview: of bounded size and rate, so that a screen costs neither the tracker nor
// itself what another subscriber of a 1080p60 camera would.
//
// It has the header of its image, shows the whole of it, and no more: pixel (u, v) of the image lies at
// ((u + 0.5) * preview.width / width - 0.5, …). With a lens to rectify it is rectified, as all of the tracker's pixels.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "laparoscope_servo/image/lens.h"

namespace laparoscope_servo {

// px, the most of either side. With 640x360 at 25 Hz a window that shows it takes some 7 % of a core, and the text and
// lines that a screen lays over it are not scaled.
constexpr int kPreviewSide = 640;
constexpr double kPreviewPeriod = 0.04;  // s, the least between two of them

class Preview {
 public:
  // `side`: px, the most of either side; at least 1.
  explicit Preview(int side = kPreviewSide) : side_(side) {}

  // Whether the image that has come at `now` [s, steady] is to be shown; it then counts as shown.
  bool due(double now);
  // 8UC1 or 8UC3, of the image's type. May share the image's data when it is small already.
  cv::Mat of(const cv::Mat& image, const std::shared_ptr<const image::Lens>& lens);

 private:
  void prepareMap(const cv::Size& image, const cv::Size& preview, const std::shared_ptr<const image::Lens>& lens);

  int side_;
  double next_ = -1.0;
  std::shared_ptr<const image::Lens> lens_;  // that the map is of
  cv::Size image_size_;
  cv::Mat map_, map_weights_;
};

}  // namespace laparoscope_servo
