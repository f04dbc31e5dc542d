// Estimates where the target is, and its own motion.
//
// The target's place is given by the features (x, y, log depth, alpha) as seen by a camera at the reference: the
// displacement to the target according to the image, plus the sum of the scope's small motions, each in its axes of
// that time. For tissue at rest it is constant: exactly for motions along one direction, to first order in their angles
// otherwise. A Kalman filter for each feature, with a place and a velocity. The scope's own motion is not known
// exactly, since d2, Z* and the delay are only estimates; so a share of it is process noise.
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

  // Takes a place measured at `time` [s], and the scope's motion since the last one. Starts anew if time does not
  // increase.
  void observe(double time, const Features& place, const Features& moved);

  // Prediction for `time`, which may be after the last measurement.
  TargetPrediction predict(double time) const;

  // See TargetMotionConfig::significance.
  void setSignificance(double significance) { config_.significance = significance; }

  bool empty() const { return !initialised_; }
  void reset() { initialised_ = false; }

 private:
  struct Axis {
    Eigen::Vector2d state = Eigen::Vector2d::Zero();  // place, velocity
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    bool moves = false;  // its velocity is significant
  };
  TargetMotionConfig config_;
  bool initialised_ = false;
  double time_ = 0.0;
  Axis axes_[4];
};

}  // namespace laparoscope_servo::servo
