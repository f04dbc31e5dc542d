// Looks for a point around the place where it is expected, by the correlation of its first view.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "features/points/affine_fit.h"
#include "features/points/point_image.h"

namespace laparoscope_servo::features {

class PointSearch {
 public:
  // `range`: px around the place, in each direction. `half`: of the views' windows.
  PointSearch(double range, int half);

  // The best place within range of `pose.place`, to half a pixel of the level it is looked for on: twice the first
  // view's pixels; sets gain and offset, too. False when nothing there can be compared. Does not allocate.
  bool find(const PointView& view, const PointImage& image, PointPose& pose);

 private:
  double range_;
  std::vector<float> values_;       // of the warped view
  std::vector<std::ptrdiff_t> at_;  // where they are in the image, from the centre
};

}  // namespace laparoscope_servo::features
