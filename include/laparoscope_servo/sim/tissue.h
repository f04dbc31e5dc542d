// The tissue: a textured plane, and its exact images.
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/sim/scene_config.h"

namespace laparoscope_servo::sim {

// The points X with normal'X = distance, in a camera's frame; the normal is a unit vector that points away from the
// camera while distance > 0.
struct Plane {
  Eigen::Vector3d normal;
  double distance;  // m
};

Plane planeSeenFrom(const Eigen::Isometry3d& base_T_camera, const Eigen::Isometry3d& base_T_tissue);

// aesop_base_T_tissue for which the tissue has the configured distance and tilt from the camera at its start pose.
Eigen::Isometry3d placeTissue(const TissueConfig& config, const Eigen::Isometry3d& base_T_start_camera);

// The true G (ground truth for trackers): pixels of the reference image to pixels of the current one, determinant 1.
// Throws std::invalid_argument when the reference camera is not in front of the tissue, or the current one lies in its
// plane.
Eigen::Matrix3d trueHomography(const geometry::PinholeCamera& camera, const Eigen::Isometry3d& base_T_tissue,
                               const Eigen::Isometry3d& base_T_reference, const Eigen::Isometry3d& base_T_current);

class Tissue {
 public:
  // `texture` CV_8UC3, not empty; `width` [m] is that of the texture, its height follows. Throws std::invalid_argument.
  Tissue(const cv::Mat& texture, double width, const Eigen::Isometry3d& base_T_tissue);

  const Eigen::Isometry3d& pose() const { return base_T_tissue_; }
  const cv::Mat& texture() const { return pyramid_.front(); }

  // The texture as the camera sees it, without light, CV_8UC3: each pixel is the mean of supersampling² samples of the
  // texture at a matching pyramid level, which avoids aliasing. Points behind the camera are black, and so is the whole
  // image if the camera is not in front of the tissue.
  cv::Mat view(const geometry::PinholeCamera& camera, const cv::Size& size, int supersampling,
               const Eigen::Isometry3d& base_T_camera) const;

 private:
  // Takes pixels of the texture to points (x, y) of the tissue's plane [m], homogeneous.
  Eigen::Matrix3d metresFromTexels() const;

  std::vector<cv::Mat> pyramid_;  // each level half the size of the one before
  double width_;
  Eigen::Isometry3d base_T_tissue_;
};

}  // namespace laparoscope_servo::sim
