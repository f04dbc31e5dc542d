#include "servo/prediction/target_motion.h"

#include <cmath>

namespace laparoscope_servo::servo {

void TargetMotion::observe(double time, const Features& place, const Features& moved) {
  const Features noise =
      Features(config_.centre_noise, config_.centre_noise, config_.depth_noise, config_.orientation_noise).cwiseAbs2();
  const double dt = time - time_;
  time_ = time;
  if (!initialised_ || !(dt > 0.0)) {
    for (int k = 0; k < 4; ++k)
      axes_[k] = {Eigen::Vector2d(place[k], 0.0), Eigen::Vector2d(noise[k], 0.0).asDiagonal(), false};
    initialised_ = true;
    return;
  }
  const Features wander =
      dt * Features(config_.centre_wander, config_.centre_wander, config_.depth_wander, config_.orientation_wander)
               .cwiseAbs2() +
      (config_.calibration * moved).cwiseAbs2();
  const Features acceleration = dt * Features(config_.centre_acceleration, config_.centre_acceleration,
                                              config_.depth_acceleration, config_.orientation_acceleration)
                                         .cwiseAbs2();
  Eigen::Matrix2d transition;
  transition << 1.0, dt, 0.0, std::exp(-config_.damping * dt);
  for (int k = 0; k < 4; ++k) {
    Axis& axis = axes_[k];
    axis.state = transition * axis.state;
    axis.covariance = transition * axis.covariance * transition.transpose();
    axis.covariance.diagonal() += Eigen::Vector2d(wander[k] + acceleration[k] * dt * dt / 3.0, acceleration[k]);
    axis.covariance(0, 1) += 0.5 * acceleration[k] * dt;
    axis.covariance(1, 0) = axis.covariance(0, 1);
    double innovation = place[k] - axis.state[0];
    if (k == 3) innovation = std::remainder(innovation, 2.0 * M_PI);  // full turns do not matter
    const double expected = axis.covariance(0, 0) + noise[k];
    if (!(innovation * innovation < config_.jump * config_.jump * expected)) {  // another target: starts at rest
      axis = {Eigen::Vector2d(place[k], 0.0), Eigen::Vector2d(noise[k], 0.0).asDiagonal(), false};
      continue;
    }
    const Eigen::Vector2d gain = axis.covariance.col(0) / expected;
    axis.state += gain * innovation;
    axis.covariance -= gain * axis.covariance.row(0).eval();
    const double significance = std::abs(axis.state[1]) / std::sqrt(axis.covariance(1, 1));
    axis.moves = significance > (axis.moves ? config_.significance / 3.0 : config_.significance);
  }
}

TargetPrediction TargetMotion::predict(double time) const {
  TargetPrediction prediction;
  if (!initialised_) return prediction;
  const double ahead = time - time_;
  for (int k = 0; k < 4; ++k) {
    const Axis& axis = axes_[k];
    prediction.place[k] = axis.state[0];
    if (!axis.moves) continue;
    const double kept = std::exp(-config_.damping * ahead);
    prediction.velocity[k] = kept * axis.state[1];
    prediction.place[k] += axis.state[1] * (config_.damping > 0.0 ? (1.0 - kept) / config_.damping : ahead);
  }
  return prediction;
}

}  // namespace laparoscope_servo::servo
