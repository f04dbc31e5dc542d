// ViSP's model-based tracker, by edges, with the settings that come with its cube.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <opencv2/core.hpp>
#include <string>

#include "laparoscope_servo/geometry/camera.h"

namespace laparoscope_servo::bench {

class VispModel {
 public:
  // `path`: of the .cao file. `range`: px along the normal.
  VispModel(const std::string& path, const geometry::PinholeCamera& camera, int range);
  ~VispModel();
  // False when it refuses.
  bool select(const cv::Mat& image, const Eigen::Isometry3d& camera_T_object);
  // False when it says that it lost the object.
  bool track(const cv::Mat& image);
  Eigen::Isometry3d pose() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace laparoscope_servo::bench
