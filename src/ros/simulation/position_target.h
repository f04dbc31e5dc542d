// The target of the task POSITION, for rviz: where the camera was when the region was selected, with its field of view
// from there and the region's outline in it.
#pragma once

#include <laparoscope_servo/Homography.h>
#include <tf2/buffer_core.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo {

class PositionTarget {
 public:
  // `base`, `camera`: tf frames.
  PositionTarget(const std::string& base, const std::string& camera) : base_(base), camera_(camera) {}

  // Takes what the tracker says of an image. The camera's pose at a selection is looked up until tf knows it.
  void take(const Homography& message, const tf2::BufferCore& tf);

  // Adds the field of view, the outline in it, both `depth` [m] before the camera, and the camera's way there. Deletes
  // them where the target is not `wanted`, nothing is selected, or tf does not reach back to the selection.
  void addTo(visualization_msgs::MarkerArray& array, bool wanted, const geometry::PinholeCamera& camera,
             const cv::Size& size, double depth, const std::optional<Eigen::Vector3d>& camera_now) const;

 private:
  std::string base_, camera_;
  ros::Time selection_;                           // zero: nothing is selected
  geometry::Quadrilateral outline_{};             // px, in the image of the selection
  std::optional<Eigen::Isometry3d> base_T_then_;  // of the camera
};

}  // namespace laparoscope_servo
