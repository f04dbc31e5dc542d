// A lens of each model, and one whose camera is turned.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "support/synthetic_lens.h"

namespace laparoscope_servo::image {

inline const cv::Size kSize(640, 480);

inline std::vector<LensParameters> models() {
  LensParameters turned = test::rational(kSize, 500.0);
  turned.rotation = Eigen::AngleAxisd(0.05, Eigen::Vector3d(0.2, 1.0, -0.4).normalized()).toRotationMatrix();
  return {test::laparoscope(kSize, 500.0), test::rational(kSize, 500.0), test::equidistant(kSize, 300.0), turned};
}

inline std::string name(const LensParameters& p) {
  return "model " + std::to_string(static_cast<int>(p.distortion));
}

}  // namespace laparoscope_servo::image
