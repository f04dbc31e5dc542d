// The outline of a dot, an ellipse about its centre: how far pixels lie from it, and in which part of it.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace laparoscope_servo::features {

constexpr int kSectors = 12;  // parts of a turn

class DotOutline {
 public:
  // d'Md = 1, d from the centre; 1/px^2. `minor`: px, the smaller radius.
  DotOutline(const Eigen::Matrix2d& m, double minor);

  // How far outside of the outline about `centre` the `count` pixels of a row lie, px, the first of them `first`:
  // (t - 1) / |grad t| with t^2 = d'Md; exact for a circle, negative inside, -minor at the centre.
  void distances(const cv::Point& first, const Eigen::Vector2d& centre, int count, float* result) const;

 private:
  float uu_, uv_, vv_;
  float minor_;
};

// The sector, 0 to kSectors - 1 from -180 degrees on, in which (u, v) lies as seen from the centre; that itself lies in
// that of the angle 0.
int sectorOf(double u, double v);

}  // namespace laparoscope_servo::features
