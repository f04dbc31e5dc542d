#include "screen/region_message.h"

#include <algorithm>

namespace laparoscope_servo::screen {

int side(std::uint32_t pixels) {
  constexpr std::uint32_t kLargest = 1u << 20;
  return static_cast<int>(std::min(pixels, kLargest));
}

QRect pixelsOf(const sensor_msgs::RegionOfInterest& roi) {
  return {side(roi.x_offset), side(roi.y_offset), side(roi.width), side(roi.height)};
}

sensor_msgs::RegionOfInterest messageOf(const QRect& pixels) {
  sensor_msgs::RegionOfInterest roi;
  roi.x_offset = static_cast<std::uint32_t>(pixels.x());
  roi.y_offset = static_cast<std::uint32_t>(pixels.y());
  roi.width = static_cast<std::uint32_t>(pixels.width());
  roi.height = static_cast<std::uint32_t>(pixels.height());
  return roi;
}

}  // namespace laparoscope_servo::screen
