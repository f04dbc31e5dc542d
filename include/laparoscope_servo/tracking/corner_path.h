// Where the corners of a region were in the last images.
#pragma once

#include <deque>
#include <optional>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::tracking {

class CornerPath {
 public:
  static constexpr std::size_t kMemory = 64;  // images: 2.6 s at 25 Hz

  // Those of the next image, nothing where the region was not tracked.
  void add(const std::optional<geometry::Quadrilateral>& corners);
  void clear() { corners_.clear(); }

  // How far [px] the corner that moved most is from where it was in any of the last `images`; 0 where that is not
  // known.
  double farthest(const geometry::Quadrilateral& corners, int images) const;

 private:
  std::deque<std::optional<geometry::Quadrilateral>> corners_;  // the newest one first
};

}  // namespace laparoscope_servo::tracking
