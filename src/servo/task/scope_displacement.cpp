#include "servo/task/scope_displacement.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "servo/law/feature_law.h"

namespace laparoscope_servo::servo {

namespace {

// Newton's method doubles the correct digits in each step near the solution; if it has not converged after 20 steps,
// there is no solution.
constexpr int kMaxSteps = 20;
constexpr double kConverged = 1e-12;  // rad and m, the last step: 4 digits above a double's rounding

// The rotation vector [rad], in the shaft's axes.
Eigen::Vector3d rotationOf(const Eigen::Vector4d& displacement) {
  return scope::angularVelocity(scope::Velocity::fromVector(displacement));
}

Eigen::Vector3d alongShaft(const Eigen::Vector4d& displacement) {
  return {0.0, 0.0, displacement[3]};
}

// Change of the image direction of `d` at the normalised image point of `p`.
double turnOf(const Eigen::Vector3d& d, const Eigen::Vector3d& p, double angle) {
  const Eigen::Vector2d m = p.head<2>() / p.z();
  const double seen = std::atan2(d.y() - m.y() * d.z(), d.x() - m.x() * d.z());
  return std::remainder(seen - angle, 2.0 * M_PI);
}

}  // namespace

Eigen::Vector3d movedPoint(const Eigen::Vector3d& point, const Eigen::Vector4d& displacement,
                           const scope::Geometry& scope) {
  const Eigen::Vector3d lever(0.0, 0.0, scope.d2);
  const Eigen::Vector3d before = scope.camera_R_shaft.transpose() * point;
  return scope.camera_R_shaft *
         (geometry::so3Exp(-rotationOf(displacement)) * (before + lever) - lever - alongShaft(displacement));
}

Eigen::Vector4d composed(const Eigen::Vector4d& first, const Eigen::Vector4d& second) {
  const Eigen::Vector3d total =
      geometry::so3Log(geometry::so3Exp(rotationOf(first)) * geometry::so3Exp(rotationOf(second)));
  return {total.y(), total.x(), total.z(), first[3] + second[3]};
}

TaskError moved(const TaskError& error, const Eigen::Vector4d& displacement, const scope::Geometry& scope,
                double desired_depth) {
  const double depth = depthOf(error, desired_depth);
  const Eigen::Matrix3d& camera_R_shaft = scope.camera_R_shaft;
  const Eigen::Vector3d rotation = rotationOf(displacement);
  const Eigen::Matrix3d now_R_before = geometry::so3Exp(-rotation);  // rotation of the shaft
  const Eigen::Vector3d seen = movedPoint({depth * error.x, depth * error.y, depth}, displacement, scope);

  TaskError result = error;
  if (!(seen.z() > 0.0)) {
    result.x = result.y = result.log_depth = result.alpha = std::numeric_limits<double>::quiet_NaN();
    result.e_v.setConstant(result.x);
    result.e_w.setConstant(result.x);
    return result;
  }
  result.x = seen.x() / seen.z();
  result.y = seen.y() / seen.z();
  result.log_depth = error.log_depth + std::log(seen.z() / depth);
  const Eigen::Matrix3d turned = camera_R_shaft * now_R_before * camera_R_shaft.transpose();
  const double c = std::cos(error.alpha), s = std::sin(error.alpha);
  const double turn = 0.5 * (turnOf(turned * Eigen::Vector3d(c, s, 0.0), seen, error.alpha) +
                             turnOf(turned * Eigen::Vector3d(-s, c, 0.0), seen, error.alpha + 0.5 * M_PI));
  result.alpha = std::remainder(error.alpha + turn, 2.0 * M_PI);

  const double scale = (error.e_v + error.m_star).z() / depth;  // H m* = e_v + m* is the centre over Z*, eq. (6)
  result.e_v = scale * seen - error.m_star;                     // eq. (6)
  result.e_w = error.e_w - 2.0 * (camera_R_shaft * rotation);   // eq. (6), [e_w]x = H - H'
  return result;
}

Eigen::Vector4d displacementToTarget(const TaskError& error, const scope::Geometry& scope, double desired_depth) {
  Eigen::Vector4d displacement = Eigen::Vector4d::Zero();
  for (int step = 0; step < kMaxSteps; ++step) {
    const TaskError there = moved(error, displacement, scope, desired_depth);
    scope::Geometry scope_there = scope;
    scope_there.d2 += displacement[3];
    const Eigen::Matrix4d j = featureJacobian(there.x, there.y, depthOf(there, desired_depth), scope_there);
    const Eigen::Vector4d off(there.x - there.desired_x, there.y - there.desired_y,
                              there.log_depth - there.desired_log_depth,
                              std::remainder(there.alpha - there.desired_alpha, 2.0 * M_PI));
    const Eigen::Vector4d change = -(j.inverse() * off);
    if (!change.allFinite()) break;
    displacement = composed(displacement, change);
    if (change.norm() < kConverged) return displacement;
  }
  return Eigen::Vector4d::Constant(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace laparoscope_servo::servo
