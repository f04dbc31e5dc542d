// Where the corners of a region were in the last images.
#pragma once

#include <deque>
#include <optional>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::tracking {

class CornerPath {
 public:
  static constexpr std::size_t kMemory = 64;  // images: 2.6 s at 25 Hz

  // Adds the corners in the next image; empty if the region was not tracked there.
  void add(const std::optional<geometry::Quadrilateral>& corners);
  void clear() { corners_.clear(); }

  // Largest distance [px] of a corner from its place in any of the last `images` images; 0 if that is not known.
  double farthest(const geometry::Quadrilateral& corners, int images) const;

 private:
  std::deque<std::optional<geometry::Quadrilateral>> corners_;  // the newest one first
};

}  // namespace laparoscope_servo::tracking
