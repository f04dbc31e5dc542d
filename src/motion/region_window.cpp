#include "motion/region_window.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::motion {

namespace {

constexpr int kLeast = 64;  // px a side, as of an image

// Half of the region on each side, which the region may move by from one image to the next. Votes reach three pixels of
// the coarsest level (ShiftVotes), on which the window has fewer than 96: less than an eighth of that.
int sideOf(double region, int image) {
  return std::clamp(static_cast<int>(std::ceil(2.0 * region)), kLeast, image);
}

int firstOf(double middle, int side, int image) {
  const double first = std::clamp(middle - 0.5 * (side - 1), 0.0, static_cast<double>(image - side));
  return static_cast<int>(std::lround(first));
}

}  // namespace

Eigen::Matrix3d imageFromBox(const cv::Rect& box) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m.topRightCorner<2, 1>() << box.x, box.y;
  return m;
}

Eigen::Vector2d middleOf(const cv::Rect& box) {
  return {box.x + 0.5 * (box.width - 1), box.y + 0.5 * (box.height - 1)};
}

RegionWindow::RegionWindow(const geometry::Rectangle& region, const cv::Size& image)
    : size_(sideOf(region.width, image.width), sideOf(region.height, image.height)), image_(image) {}

cv::Rect RegionWindow::about(const geometry::Quadrilateral& region) const {
  const Eigen::Vector2d middle = 0.25 * (region[0] + region[1] + region[2] + region[3]);
  if (!middle.allFinite()) return {{0, 0}, size_};
  return {{firstOf(middle.x(), size_.width, image_.width), firstOf(middle.y(), size_.height, image_.height)}, size_};
}

}  // namespace laparoscope_servo::motion
