#include "servo/prediction/breathing.h"

namespace laparoscope_servo::servo {

namespace {

constexpr int kChannels = 3;  // x, y, log depth

}  // namespace

Breathing::Breathing(const BreathingConfig& config, const TargetMotionConfig& target)
    : config_(config),
      noise_(target.centre_noise),
      depth_scale_(target.centre_noise / target.depth_noise),
      filter_(config.filter, kChannels) {
  if (config_.rate > 0.0) filter_.seed(config_.rate, config_.rate_stddev);
}

bool Breathing::observe(double time, const Features& place) {
  if (!config_.enabled) return false;
  const bool was_there = filter_.locked();
  filter_.update(time, Eigen::Vector3d(place[0], place[1], depth_scale_ * place[2]), noise_);
  return filter_.locked() != was_there;
}

TargetPrediction Breathing::predict(double time) const {
  TargetPrediction prediction;
  if (!filter_.locked()) return prediction;
  const PeriodicMotion motion = filter_.predict(time);
  prediction.place.head<3>() << motion.position[0], motion.position[1], motion.position[2] / depth_scale_;
  prediction.velocity.head<3>() << motion.velocity[0], motion.velocity[1], motion.velocity[2] / depth_scale_;
  return prediction;
}

}  // namespace laparoscope_servo::servo
