// The motions of a camera that a homography of a plane allows: R + t n'/d has two of them in general.
#pragma once

#include <Eigen/Core>
#include <array>

namespace laparoscope_servo::geometry {

struct PlaneMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // directions in the reference frame to the current one
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();   // t/d: of the same motion, over the plane's distance
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();       // n in the reference frame, away from the camera, n'm > 0
};

// `h`: scaled to R + t n'/d, see euclideanScale(). `m`: the homogeneous point, m_z > 0, that has to be in front of the
// camera. Both motions take points of the plane to where h takes them. Equal where nothing but the rotation shows, or
// where the plane's normal is that of the translation. Decomposition by the singular vectors: Ma, Soatto, Kosecka and
// Sastry, An invitation to 3-D vision (2004), section 5.3.
std::array<PlaneMotion, 2> planeMotions(const Eigen::Matrix3d& h, const Eigen::Vector3d& m);

}  // namespace laparoscope_servo::geometry
