#include "laparoscope_servo/tracking/corner_path.h"

#include <algorithm>

namespace laparoscope_servo::tracking {

void CornerPath::add(const std::optional<geometry::Quadrilateral>& corners) {
  corners_.push_front(corners);
  if (corners_.size() > kMemory) corners_.pop_back();
}

double CornerPath::farthest(const geometry::Quadrilateral& corners, int images) const {
  double most = 0.0;
  const std::size_t count = std::min(corners_.size(), static_cast<std::size_t>(std::max(0, images)));
  for (std::size_t image = 0; image < count; ++image) {
    if (corners_[image]) most = std::max(most, geometry::largestDistance(corners, *corners_[image]));
  }
  return most;
}

}  // namespace laparoscope_servo::tracking
