#include "model/instrument/grey_plane.h"

#include <algorithm>

namespace laparoscope_servo::model {

namespace {

constexpr int kDoubt = 6;  // grey levels: added to red, so that what is nearly black is not grey

}  // namespace

// The mean of green and blue over red falls with S0 cos H, eq. (4) and (5) of Bourger et al. (2007), and needs neither
// root nor division here.
GreyPlane::GreyPlane() {
  for (int red = 0; red < 256; ++red) {
    scale_[static_cast<std::size_t>(red)] = static_cast<std::uint32_t>(kGrey * 65536.0 / (2.0 * (red + kDoubt)));
  }
}

void GreyPlane::compute(const cv::Mat& image, const cv::Rect& part) {
  if (plane_.size() != image.size()) plane_ = cv::Mat1b::zeros(image.size());
  const cv::Rect inside = part & cv::Rect(cv::Point(0, 0), image.size());
  for (int y = inside.y; y < inside.y + inside.height; ++y) {
    const uchar* p = image.ptr<uchar>(y) + 3 * inside.x;
    uchar* q = plane_[y] + inside.x;
    for (int x = 0; x < inside.width; ++x, p += 3) {
      const std::uint32_t value = (static_cast<std::uint32_t>(p[0]) + p[1]) * scale_[p[2]] >> 16;
      q[x] = static_cast<uchar>(std::min<std::uint32_t>(value, 255));
    }
  }
}

}  // namespace laparoscope_servo::model
