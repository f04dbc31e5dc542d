// Pose of a cylinder of known radius from the lines that its outline makes in the image of a pinhole camera.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "laparoscope_servo/geometry/camera.h"

namespace laparoscope_servo::model {

// Camera frame: optical, REP-103, m.
struct CylinderPose {
  Eigen::Vector3d point =
      Eigen::Vector3d::Zero();  // on the axis: at the tip, where that is known, else nearest to the camera
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  // of the axis, towards the tip
  // Of small motions of the cylinder, camera frame: translation (m) of `point`, then rotation (rad) about it. Turning
  // about the axis, and sliding along it unless the tip is known, are open: their variances are kOpen.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();

  static constexpr double kOpen = 1e6;  // m^2, rad^2
};

// A line x cos(theta) + y sin(theta) = rho, px, whose normal points away from the cylinder, and its covariance.
struct OutlineLine {
  double rho = 0.0;
  double theta = 0.0;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // of (rho, theta)
};

// `lines`: right and left of who looks towards the tip. `tip`: px, with its variance along the axis, px^2. Empty when
// the lines are no outline of a cylinder in front of the camera: parallel normals, the camera inside of it, not finite.
std::optional<CylinderPose> cylinderPose(const geometry::PinholeCamera& camera, double radius,
                                         const std::array<OutlineLine, 2>& lines,
                                         const std::optional<Eigen::Vector2d>& tip = std::nullopt,
                                         double tip_variance = 0.0);

}  // namespace laparoscope_servo::model
