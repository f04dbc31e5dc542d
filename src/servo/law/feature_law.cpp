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

Eigen::Matrix4d inverseOf(const Eigen::Matrix4d& jacobian, const LawAxes& axes) {
  // Features are in the order x, y, log depth, alpha; velocities in the order pan, tilt, spin, insertion.
  constexpr int kDepth = 2, kAlpha = 3, kSpin = 2, kInsertion = 3;
  // A unit row and column in place of each degree of freedom that is not used keeps the others' block by itself.
  Eigen::Matrix4d part = jacobian;
  const auto leaveOut = [&part](int feature, int velocity) {
    part.row(feature).setZero();
    part.col(velocity).setZero();
    part(feature, velocity) = 1.0;
  };
  if (!axes.spin) leaveOut(kAlpha, kSpin);
  if (!axes.insertion) leaveOut(kDepth, kInsertion);
  Eigen::Matrix4d inverse = part.inverse();
  if (!axes.spin) inverse(kSpin, kAlpha) = 0.0;
  if (!axes.insertion) inverse(kInsertion, kDepth) = 0.0;
  return inverse;
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
  const Eigen::Matrix4d inverse = inverseOf(j, axes_);
  const double turn = shortTurn(error.alpha - error.desired_alpha);
  LawVelocity velocity;
  velocity.centring = scope::Velocity::fromVector(inverse.leftCols<3>() * centring);
  velocity.turning = scope::Velocity::fromVector(inverse.col(3) * (-gains_.orientation * turn));
  return velocity;
}

}  // namespace laparoscope_servo::servo
