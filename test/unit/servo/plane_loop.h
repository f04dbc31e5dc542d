// The loop in continuous time, without a robot: a scope about an insertion point before a plane.
#pragma once

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/scope/geometry.h"
#include "laparoscope_servo/servo/task_function.h"

namespace laparoscope_servo::servo::test {

const geometry::PinholeCamera kCamera{400.0, 400.0, 319.5, 239.5};
const geometry::Rectangle kRoi{270.0, 190.0, 100.0, 100.0};
const double kD2 = 0.1;
const double kZ = 0.08;

// The scope stands where it is after moving from the reference pose.
class PlaneLoop {
 public:
  PlaneLoop(const Eigen::Vector3d& normal, double depth, const scope::Geometry& scope)
      : normal_(normal), depth_(depth), scope_(scope) {}

  void move(const scope::Velocity& velocity, double dt) {
    scope::Geometry middle = scope_;
    middle.d2 += 0.5 * dt * velocity.insertion;
    reference_T_camera_ =
        reference_T_camera_ * geometry::se3Exp(dt * (scope::insertionPointMotions(middle) * velocity.vector()));
    scope_.d2 += dt * velocity.insertion;
  }

  // An offset from the reference pose: turned about the insertion point, and pushed in meanwhile.
  void offset(const scope::Velocity& displacement) {
    for (int k = 0; k < 100; ++k) move(displacement, 0.01);
  }

  Eigen::Matrix3d homography() const { return geometry::fromPlane(reference_T_camera_.inverse(), normal_, depth_); }
  TaskError error() const { return taskError(homography(), kRoi, kCamera); }
  const scope::Geometry& scope() const { return scope_; }

  bool visible() const {
    const geometry::Quadrilateral corners =
        geometry::apply(geometry::pixelsFromNormalised(homography(), kCamera), kRoi.corners());
    if (!geometry::isConvex(corners)) return false;
    for (const Eigen::Vector2d& corner : corners) {
      if (!(corner.x() >= 0.0 && corner.x() <= 639.0 && corner.y() >= 0.0 && corner.y() <= 479.0)) return false;
    }
    return true;
  }

 private:
  Eigen::Vector3d normal_;
  double depth_;
  scope::Geometry scope_;
  Eigen::Isometry3d reference_T_camera_ = Eigen::Isometry3d::Identity();
};

inline double sizeOf(const TaskError& error) {
  return std::max({std::abs(error.x - error.desired_x), std::abs(error.y - error.desired_y), std::abs(error.log_depth),
                   std::abs(error.alpha)});
}

inline scope::Geometry straight(double d2 = kD2) {
  return {Eigen::Matrix3d::Identity(), d2};
}

}  // namespace laparoscope_servo::servo::test
