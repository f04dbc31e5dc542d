// The periodic part of the target's motion, in its features.
#pragma once

#include "laparoscope_servo/servo/prediction_config.h"
#include "servo/prediction/harmonic_filter.h"
#include "servo/prediction/target_motion.h"

namespace laparoscope_servo::servo {

class Breathing {
 public:
  // The configuration must be valid. `target`: for the noise of its measurements.
  Breathing(const BreathingConfig& config, const TargetMotionConfig& target);

  // Takes a place measured at `time` [s]. Returns true if breathing was found or lost with it: estimates from earlier
  // places are then invalid.
  bool observe(double time, const Features& place);

  // The periodic part of the target's place and velocity, at most a second ahead; zero while no breathing is found.
  // alpha is always zero.
  TargetPrediction predict(double time) const;

  // Breathing rate [Hz]; 0 while none is found.
  double rate() const { return filter_.frequency(); }
  void reset() { filter_.reset(); }

 private:
  BreathingConfig config_;
  double noise_;        // of x and y
  double depth_scale_;  // scales log depth so that its noise is that of x and y
  HarmonicFilter filter_;
};

}  // namespace laparoscope_servo::servo
