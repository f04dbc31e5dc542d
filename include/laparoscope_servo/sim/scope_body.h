// A rigid scope in space, moved by the velocity of its end-effector, and its distance from an insertion point.
//
// Frames (parallel axes, z along the shaft into the body): end-effector O_7, and the tip of the shaft, where the
// camera's centre O_C is, a length l ahead of it. A stiff wrist holds the scope's direction: staying at the insertion
// point is the caller's task, and the distance is measured here. With a passive wrist the insertion point determines
// the direction.
#pragma once

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::sim {

enum class Wrist { kStiff, kPassive };

class ScopeBody {
 public:
  // `insertion_point` in world coordinates [m], `length` l > 0 [m].
  ScopeBody(const Eigen::Isometry3d& world_T_tip, const Eigen::Vector3d& insertion_point, double length,
            Wrist wrist = Wrist::kStiff)
      : world_T_tip_(world_T_tip), insertion_point_(insertion_point), length_(length), wrist_(wrist) {}

  // Moves for `dt` [s] with a constant twist of the end-effector, expressed in its frame. With a passive wrist only the
  // end-effector's translation and the spin have an effect.
  void move(const geometry::Vector6d& end_effector_twist, double dt);

  // Moves the insertion point to world coordinates [m]; a passive wrist follows it.
  void moveInsertionPoint(const Eigen::Vector3d& insertion_point);

  // The tip's twist, in its frame, for this twist of the end-effector and a stiff wrist.
  geometry::Vector6d tipTwist(const geometry::Vector6d& end_effector_twist) const;

  // world_T_tip.
  const Eigen::Isometry3d& pose() const { return world_T_tip_; }

  // m, along the shaft from the insertion point to the camera.
  double depth() const { return -insertionPointAtTip().z(); }
  // m, distance from the insertion point to the shaft.
  double lateralOffset() const { return insertionPointAtTip().head<2>().norm(); }
  double length() const { return length_; }

 private:
  Eigen::Vector3d insertionPointAtTip() const { return world_T_tip_.inverse() * insertion_point_; }
  void aim();

  Eigen::Isometry3d world_T_tip_;
  Eigen::Vector3d insertion_point_;
  double length_;
  Wrist wrist_;
};

}  // namespace laparoscope_servo::sim
