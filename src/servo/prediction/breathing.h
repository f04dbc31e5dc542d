// The periodic part of the target's motion, in its features.
#pragma once

#include "laparoscope_servo/servo/prediction_config.h"
#include "servo/prediction/harmonic_filter.h"
#include "servo/prediction/target_motion.h"

namespace laparoscope_servo::servo {

class Breathing {
 public:
  // The configuration must be valid. `target`: of its noise.
  Breathing(const BreathingConfig& config, const TargetMotionConfig& target);

  // A place measured at `time` [s]. True when the breath has been found or lost with it: what was made of places before
  // does not hold.
  bool observe(double time, const Features& place);

  // Of the target's place and velocity, the part that breathing makes, at most a second ahead; zero while there is
  // none. alpha is left alone.
  TargetPrediction predict(double time) const;

  // Hz; 0 while there is none.
  double rate() const { return filter_.frequency(); }
  void reset() { filter_.reset(); }

 private:
  BreathingConfig config_;
  double noise_;        // of x and y
  double depth_scale_;  // makes the noise of log depth that of x and y
  HarmonicFilter filter_;
};

}  // namespace laparoscope_servo::servo
