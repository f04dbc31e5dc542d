// What is drawn into a mask: a quadrangle, and what lies near to what is drawn. Unlike OpenCV's fillConvexPoly and
// dilate, it does not allocate once its buffers have the image's size.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace laparoscope_servo::features {

// Sets the pixels of a convex quadrangle to 255; corners in order, px, may lie anywhere. Returns what encloses them in
// the mask.
cv::Rect drawQuadrangle(const std::array<Eigen::Vector2d, 4>& corners, cv::Mat1b& mask);

class MaskGrowth {
 public:
  // Sets to 255 in `target` each pixel that lies within `radius` px, 0 to 254, of one that is set in `box` of `source`.
  // Both masks have one size and are different ones; `box` lies within them.
  void add(const cv::Mat1b& source, const cv::Rect& box, int radius, cv::Mat1b& target);

 private:
  std::vector<std::uint8_t> distances_;  // of each pixel from the nearest one of its row that is set
};

}  // namespace laparoscope_servo::features
