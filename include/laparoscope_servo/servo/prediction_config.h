// What is known of the time from an image to the execution of the command that it leads to.
#pragma once

#include "laparoscope_servo/servo/harmonic_filter_config.h"

namespace laparoscope_servo::servo {

// What is known of the time from now to the execution of a command.
struct PredictorConfig {
  bool enabled = true;            // false: the law sees the task error of the last image as it is
  double delay = 0.16;            // s, from a command to its execution, until it is measured
  bool measure_delay = true;      // from the velocities that the robot reports
  double min_delay = 0.0;         // s, nothing less is measured
  double max_delay = 0.4;         // s, nor more
  bool feed_forward = true;       // the target's own velocity is added to the law's
  double command_lifetime = 0.2;  // s, for which the robot does what it was told last, before it stops by itself
};

// How the target's own motion is told from noise, see src/servo/prediction/target_motion.h.
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

// The breath, as far as it moves the target.
struct BreathingConfig {
  bool enabled = true;
  double rate = 0.0;           // Hz, of the ventilator; 0: not known, it is searched
  double rate_stddev = 0.002;  // Hz, of that rate
  HarmonicFilterConfig filter;
};

}  // namespace laparoscope_servo::servo
