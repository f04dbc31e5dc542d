// How grey each pixel is, in the image's resolution: what the edges of a shaft are fitted to. Brightness will not do: a
// shaft is dark where its surface turns away, next to its edges, and lit there by what it lies on.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

namespace laparoscope_servo::model {

class GreyPlane {
 public:
  // Grey levels of the plane: this one is grey, red is less, blue more.
  static constexpr int kGrey = 192;

  GreyPlane();
  // Fills `part` of the plane from `image` (CV_8UC3); the rest stays as it is, 0 in a new one.
  void compute(const cv::Mat& image, const cv::Rect& part);
  const cv::Mat1b& plane() const { return plane_; }

 private:
  cv::Mat1b plane_;
  std::array<std::uint32_t, 256> scale_;  // of green plus blue, by red, times 2^16
};

}  // namespace laparoscope_servo::model
