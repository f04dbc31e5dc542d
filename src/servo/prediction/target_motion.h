// Where the target is, and how it moves by itself.
//
// The target's place is told in the features (x, y, log depth, alpha) as a camera at the reference would see them: what
// is left to do according to the image, plus the sum of the scope's small motions, each in the axes that it had then.
// It stands still when the tissue does: exactly for motions along one direction, to first order in their angles
// otherwise. A Kalman filter for each feature, with a place and a velocity. What the scope itself does is not known
// exactly - the depths d2 and Z* are believed, the delay is -, so that its motion is part of the process noise.
#pragma once

#include <Eigen/Core>

#include "laparoscope_servo/servo/prediction_config.h"

namespace laparoscope_servo::servo {

// (x, y, log depth, alpha); x and y normalised, alpha in rad.
using Features = Eigen::Vector4d;

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

  // See TargetMotionConfig::significance.
  void setSignificance(double significance) { config_.significance = significance; }

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
