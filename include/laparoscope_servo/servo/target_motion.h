// Where the target is, and how it moves by itself.
//
// The target's place is told in the features (x, y, log depth, alpha) as a camera at the reference would see them: what
// is left to do according to the image, plus the sum of the scope's small motions, each in the axes that it had then.
// It stands still when the tissue does: exactly for motions along one direction, to first order in their angles
// otherwise. A Kalman filter for each feature, with a place and a velocity. What the scope itself does is not known
// exactly - the depths d2 and Z* are believed, the delay is -, so that its motion is part of the process noise.
#pragma once

#include <Eigen/Core>

namespace laparoscope_servo::servo {

// (x, y, log depth, alpha); x and y normalised, alpha in rad.
using Features = Eigen::Vector4d;

struct TargetMotionConfig {
  // Standard deviations of what one image tells of the ROI's centre (normalised), log depth and orientation [rad].
  double centre_noise = 0.0005;
  double depth_noise = 0.003;
  double orientation_noise = 0.003;
  double centre_wander = 0.0003;  // 1/sqrt(s): random walk of the place
  double depth_wander = 0.001;
  double orientation_wander = 0.001;  // rad/sqrt(s)
  double centre_acceleration = 0.03;  // 1/s/sqrt(s): random walk of the velocity
  double depth_acceleration = 0.012;
  double orientation_acceleration = 0.012;  // rad/s/sqrt(s)
  double calibration = 0.3;  // no unit: share of the scope's own motion that its displacement may be wrong by
  double significance =
      3.0;            // standard deviations: a velocity is believed from here on, until it falls below a third of that
  double jump = 8.0;  // standard deviations: what is seen further off is another target, not the old one in motion
  double damping = 0.1;  // 1/s: a velocity that is not seen any more decays
};

struct TargetPrediction {
  Features place = Features::Zero();
  Features velocity = Features::Zero();  // 1/s; zero where it is not significant
};

class TargetMotion {
 public:
  explicit TargetMotion(const TargetMotionConfig& config) : config_(config) {}

  // A place measured at `time` [s], and how far the scope has moved since the last one. Times that do not increase
  // start anew.
  void observe(double time, const Features& place, const Features& moved);

  // At `time`, which may lie ahead of the last measurement.
  TargetPrediction predict(double time) const;

  bool empty() const { return !initialised_; }
  void reset() { initialised_ = false; }

 private:
  struct Axis {
    Eigen::Vector2d state = Eigen::Vector2d::Zero();  // place, velocity
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    bool moves = false;  // its velocity is believed
  };
  TargetMotionConfig config_;
  bool initialised_ = false;
  double time_ = 0.0;
  Axis axes_[4];
};

}  // namespace laparoscope_servo::servo
