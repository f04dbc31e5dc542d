// A rigid scope in space, driven by the velocity of its end-effector, and where it passes an insertion point.
//
// Nothing holds it at the insertion point: whether it stays there is for who drives it, and is measured here. Frames
// (0° optics, parallel axes, z along the shaft into the body): end-effector O_7, and the camera O_C a length l ahead of
// it.
#pragma once

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::sim {

class ScopeBody {
 public:
  // `insertion_point` in world coordinates [m], `length` l > 0 [m].
  ScopeBody(const Eigen::Isometry3d& world_T_camera, const Eigen::Vector3d& insertion_point, double length)
      : world_T_camera_(world_T_camera), insertion_point_(insertion_point), length_(length) {}

  // Moves for `dt` [s] with a constant twist of the end-effector, expressed in its frame.
  void move(const geometry::Vector6d& end_effector_twist, double dt);

  // The camera's twist, in the camera frame, when the end-effector has this one.
  geometry::Vector6d cameraTwist(const geometry::Vector6d& end_effector_twist) const;

  const Eigen::Isometry3d& pose() const { return world_T_camera_; }

  // m, along the shaft from the insertion point to the camera.
  double depth() const { return -insertionPointInCamera().z(); }
  // m, from the insertion point to the shaft.
  double lateralOffset() const { return insertionPointInCamera().head<2>().norm(); }
  double length() const { return length_; }

 private:
  Eigen::Vector3d insertionPointInCamera() const { return world_T_camera_.inverse() * insertion_point_; }

  Eigen::Isometry3d world_T_camera_;
  Eigen::Vector3d insertion_point_;
  double length_;
};

}  // namespace laparoscope_servo::sim
