#include "laparoscope_servo/servo/position_error.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/geometry/plane_motion.h"
#include "laparoscope_servo/geometry/se3.h"
#include "servo/task/scope_displacement.h"

namespace laparoscope_servo::servo {

namespace {

using Features = Eigen::Vector4d;  // x, y, log(Z/Z*), (theta u)_z

constexpr int kMaxSteps = 20;         // Newton's, as displacementToTarget()
constexpr double kConverged = 1e-10;  // rad and m, the last step: three digits above the rounding of the features
constexpr double kSmallAngle = 1e-4;  // rad: the series is right to 1e-16 below it

// d(theta u)/dt = -L_w w for the camera's angular velocity w: the inverse of the left Jacobian of SO(3).
Eigen::Matrix3d rotationJacobian(const Eigen::Vector3d& theta_u) {
  const double angle = theta_u.norm();
  const Eigen::Matrix3d cross = geometry::skew(theta_u);
  const double second = angle < kSmallAngle
                            ? 1.0 / 12.0
                            : 1.0 / (angle * angle) - (1.0 + std::cos(angle)) / (2.0 * angle * std::sin(angle));
  return -(Eigen::Matrix3d::Identity() - 0.5 * cross + second * cross * cross);
}

// From the reference to the current camera, after the scope has moved by `displacement`.
Eigen::Vector3d turned(const Eigen::Vector4d& displacement, const scope::Geometry& scope) {
  return -(scope.camera_R_shaft * scope::angularVelocity(scope::Velocity::fromVector(displacement)));
}

// Of the two motions the one in which the insertion point stays nearer to the shaft. `distance`: d* [m] of a plane
// whose normal is n.
double besideShaft(const geometry::PlaneMotion& motion, const Eigen::Vector3d& m_star, const scope::Geometry& scope,
                   double desired_depth) {
  const double distance = desired_depth * motion.normal.dot(m_star);
  const Eigen::Vector3d now = scope.camera_R_shaft * Eigen::Vector3d(0.0, 0.0, -scope.d2);
  const Eigen::Vector3d before = motion.rotation.transpose() * (now - distance * motion.translation);
  return (scope.camera_R_shaft.transpose() * before).head<2>().norm();
}

// Of the point, and which way the camera has turned.
Features featuresOf(const Eigen::Vector3d& point, const Eigen::Vector3d& theta_u, double desired_depth) {
  return {point.x() / point.z(), point.y() / point.z(), std::log(point.z() / desired_depth), theta_u.z()};
}

// The orientation of a region that is as it shall be after the scope has moved by `back`.
double turnBefore(TaskError error, const Eigen::Vector4d& back, const scope::Geometry& scope, double desired_depth) {
  for (int step = 0; step < kMaxSteps; ++step) {
    const double left = std::remainder(moved(error, back, scope, desired_depth).alpha, 2.0 * M_PI);
    error.alpha = std::remainder(error.alpha - left, 2.0 * M_PI);
    if (std::abs(left) < kConverged) return error.alpha;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Eigen::Matrix4d positionJacobian(double x, double y, double depth, const Eigen::Vector3d& theta_u,
                                 const scope::Geometry& scope) {
  Eigen::Matrix<double, 4, 6> interaction;
  interaction << -1.0 / depth, 0.0, x / depth, x * y, -(1.0 + x * x), y,  // x
      0.0, -1.0 / depth, y / depth, 1.0 + y * y, -x * y, -x,              // y
      0.0, 0.0, -1.0 / depth, -y, x, 0.0,                                 // log depth
      Eigen::RowVector3d::Zero(), rotationJacobian(theta_u).row(2);       // (theta u)_z
  return interaction * scope::insertionPointMotions(scope);
}

PositionSeen positionError(const Eigen::Matrix3d& h, const Eigen::Vector3d& m_star, const scope::Geometry& scope,
                           double desired_depth) {
  PositionSeen result;
  Eigen::Matrix3d scaled;
  try {
    scaled = geometry::euclideanScale(h, m_star);
  } catch (const std::invalid_argument&) {
    return result;
  }
  const Eigen::Vector3d seen = desired_depth * scaled * m_star;
  if (!(seen.z() > 0.0)) return result;
  const auto motions = geometry::planeMotions(scaled, m_star);
  const bool second =
      besideShaft(motions[1], m_star, scope, desired_depth) < besideShaft(motions[0], m_star, scope, desired_depth);
  const Features wanted = featuresOf(seen, geometry::so3Log(motions[second ? 1 : 0].rotation), desired_depth);

  TaskError error;
  error.x = wanted[0];
  error.y = wanted[1];
  error.log_depth = wanted[2];
  error.alpha = wanted[3];
  error.desired_x = m_star.x();
  error.desired_y = m_star.y();
  error.m_star = m_star;
  error.e_v = scaled * m_star - m_star;                    // eq. (6)
  error.e_w = geometry::vee(scaled - scaled.transpose());  // eq. (6)
  // A region that faces the camera has nearly these features.
  const Eigen::Vector4d back = displacementToTarget(error, scope, desired_depth);
  Eigen::Vector4d displacement = back.allFinite() ? Eigen::Vector4d(-back) : Eigen::Vector4d::Zero();
  for (int step = 0; step < kMaxSteps; ++step) {
    scope::Geometry reference = scope;
    reference.d2 -= displacement[3];
    const Eigen::Vector3d there = movedPoint(desired_depth * m_star, displacement, reference);
    const Eigen::Vector3d theta_u = turned(displacement, scope);
    const Features features = featuresOf(there, theta_u, desired_depth);
    const Eigen::Matrix4d jacobian = positionJacobian(features[0], features[1], there.z(), theta_u, scope);
    Features off = features - wanted;
    off[3] = std::remainder(off[3], 2.0 * M_PI);
    const Eigen::Vector4d change = -(jacobian.inverse() * off);  // v = -lambda L^-1 e with lambda = 1
    displacement = composed(displacement, change);
    if (!displacement.allFinite()) return result;
    if (!(change.norm() < kConverged)) continue;
    error.alpha = turnBefore(error, -displacement, scope, desired_depth);
    result.is_known = isFinite(error);
    if (result.is_known) result.error = error;
    return result;
  }
  return result;
}

}  // namespace laparoscope_servo::servo
