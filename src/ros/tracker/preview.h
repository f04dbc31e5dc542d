// A small picture for display, on ~preview: of bounded size and rate, so that a screen does not load the tracker and
// itself with a 1080p60 stream.
//
// It has the header of its image and shows exactly the whole of it: pixel (u, v) of the image lies at ((u + 0.5) *
// preview.width / width - 0.5, …). With a lens it is rectified, like all of the tracker's pixels.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "laparoscope_servo/image/lens.h"

namespace laparoscope_servo {

// px, largest side. With 640x360 at 25 Hz a window that shows it takes about 7 % of a core; text and lines that a
// screen draws over it are not scaled.
constexpr int kPreviewSide = 640;
constexpr double kPreviewPeriod = 0.04;  // s, least time between two previews

class Preview {
 public:
  // `side`: px, largest side; at least 1.
  explicit Preview(int side = kPreviewSide) : side_(side) {}

  // Whether the image received at `now` [s, steady] is to be shown; it then counts as shown.
  bool due(double now);
  // The preview, 8UC1 or 8UC3 as the image. May share the image's data if that is small already.
  cv::Mat of(const cv::Mat& image, const std::shared_ptr<const image::Lens>& lens);

 private:
  void prepareMap(const cv::Size& image, const cv::Size& preview, const std::shared_ptr<const image::Lens>& lens);

  int side_;
  double next_ = -1.0;
  std::shared_ptr<const image::Lens> lens_;  // lens of the map
  cv::Size image_size_;
  cv::Mat map_, map_weights_;
};

}  // namespace laparoscope_servo
