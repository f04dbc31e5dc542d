#include "servo/law/feature_law.h"

#include <Eigen/LU>
#include <cmath>

namespace laparoscope_servo::servo {

Eigen::Matrix4d featureJacobian(double x, double y, double depth, const scope::Geometry& scope) {
  Eigen::Matrix<double, 4, 6> interaction;
  interaction << -1.0 / depth, 0.0, x / depth, x * y, -(1.0 + x * x), y,  // x
      0.0, -1.0 / depth, y / depth, 1.0 + y * y, -x * y, -x,              // y
      0.0, 0.0, -1.0 / depth, -y, x, 0.0,                                 // log depth
      0.0, 0.0, 0.0, -0.5 * x, -0.5 * y, -1.0;                            // alpha
  return interaction * scope::insertionPointMotions(scope);
}

double shortTurn(double turn) {
  // rad: half a turn plus 20 degrees of margin for noise, a hundred times an image's noise (target/orientation_noise).
  constexpr double kLongest = 3.5;
  return std::abs(turn) < kLongest ? turn : std::remainder(turn, 2.0 * M_PI);
}

double depthOf(const TaskError& error, double desired_depth) {
  return desired_depth * std::exp(error.log_depth - error.desired_log_depth);
}

LawVelocity FeatureLaw::velocity(const TaskError& error, const scope::Geometry& scope) const {
  const Eigen::Matrix4d j = featureJacobian(error.x, error.y, depthOf(error, gains_.desired_depth), scope);
  const Eigen::Vector3d centring(-gains_.centre * (error.x - error.desired_x),
                                 -gains_.centre * (error.y - error.desired_y),
                                 -gains_.depth * (error.log_depth - error.desired_log_depth));
  LawVelocity velocity;
  if (spin_ == SpinMode::kReleased) {
    Eigen::Matrix3d without_spin;
    without_spin << j.block<3, 2>(0, 0), j.block<3, 1>(0, 3);
    const Eigen::Vector3d u = without_spin.inverse() * centring;
    velocity.centring = {u[0], u[1], 0.0, u[2]};
    return velocity;
  }
  const Eigen::Matrix4d inverse = j.inverse();
  const double turn = shortTurn(error.alpha - error.desired_alpha);
  velocity.centring = scope::Velocity::fromVector(inverse.leftCols<3>() * centring);
  velocity.turning = scope::Velocity::fromVector(inverse.col(3) * (-gains_.orientation * turn));
  return velocity;
}

}  // namespace laparoscope_servo::servo
