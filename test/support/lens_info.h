// The camera_info of a synthetic lens.
#pragma once

#include <sensor_msgs/CameraInfo.h>

#include "synthetic_lens.h"

namespace laparoscope_servo::test_support {

inline sensor_msgs::CameraInfo lensInfo(const image::Lens& lens, const cv::Size& size) {
  const image::LensParameters& p = lens.parameters();
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(size.width);
  info.height = static_cast<std::uint32_t>(size.height);
  const char* const names[] = {"plumb_bob", "rational_polynomial", "equidistant"};
  const long counts[] = {5, 8, 4};
  const int model = static_cast<int>(p.distortion);
  info.distortion_model = names[model];
  info.D.assign(p.coefficients.begin(), p.coefficients.begin() + counts[model]);
  info.K = {p.raw.fx, 0.0, p.raw.cx, 0.0, p.raw.fy, p.raw.cy, 0.0, 0.0, 1.0};
  info.P = {p.rectified.fx, 0.0, p.rectified.cx, 0.0, 0.0, p.rectified.fy, p.rectified.cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  for (int k = 0; k < 9; ++k) info.R[static_cast<std::size_t>(k)] = p.rotation(k / 3, k % 3);
  return info;
}

}  // namespace laparoscope_servo::test_support
