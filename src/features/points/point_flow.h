// Follows a window from one image to the next by translation (Lucas and Kanade, the tracker of Shi and Tomasi), from
// the coarsest level of the pyramid down.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "features/points/point_image.h"
#include "features/points/window.h"

namespace laparoscope_servo::features {

// What a point's neighbourhood looked like in the last image, at each level.
class FlowMemory {
 public:
  // Allocates at the first call.
  void keep(const PointImage& image, const Eigen::Vector2d& place, int half);
  void forget() { kept_ = 0; }
  int levels() const { return kept_; }
  const Window& window(int l) const { return windows_[static_cast<std::size_t>(l)]; }
  double share(int l) const { return shares_[static_cast<std::size_t>(l)]; }

 private:
  int kept_ = 0;
  std::vector<Window> windows_;
  std::vector<double> shares_;  // of valid pixels
};

class PointFlow {
 public:
  explicit PointFlow(int half) : now_(half) {}

  // Where what was kept is in `image`, from `start` on: px. False where no level tells. To a fraction of a pixel of the
  // level `finest`. Does not allocate.
  bool follow(const FlowMemory& memory, const PointImage& image, int finest, Eigen::Vector2d& place);

 private:
  bool followAt(const Window& before, const PointImage& image, int l, Eigen::Vector2d& place);
  double mismatch(const Window& before, Eigen::Vector2d* right);

  Window now_;
};

}  // namespace laparoscope_servo::features
