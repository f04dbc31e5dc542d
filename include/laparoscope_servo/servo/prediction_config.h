// Parameters of the prediction from the time of an image to the execution of the command.
#pragma once

#include "laparoscope_servo/servo/harmonic_filter_config.h"

namespace laparoscope_servo::servo {

// Prediction over the delay between a command and its execution.
struct PredictorConfig {
  bool enabled = true;            // false: the law gets the task error of the last image as it is
  double delay = 0.16;            // s, from a command to its execution, until it is measured
  bool measure_delay = true;      // from the velocities that the robot reports
  double min_delay = 0.0;         // s, lower bound of the measured delay
  double max_delay = 0.4;         // s, upper bound of the measured delay
  bool feed_forward = true;       // the target's own velocity is added to the law's
  double command_lifetime = 0.2;  // s, for which the robot executes the last command before it stops by itself
};

// Model of the target's own motion and of the noise, see src/servo/prediction/target_motion.h.
struct TargetMotionConfig {
  // Standard deviations of one image's measurement of the ROI's centre (normalised), log depth and orientation [rad].
  double centre_noise = 0.0005;
  double depth_noise = 0.003;
  double orientation_noise = 0.003;
  double centre_wander = 0.0003;  // 1/sqrt(s): random walk of the place
  double depth_wander = 0.001;
  double orientation_wander = 0.001;  // rad/sqrt(s)
  double centre_acceleration = 0.03;  // 1/s/sqrt(s): random walk of the velocity
  double depth_acceleration = 0.012;
  double orientation_acceleration = 0.012;  // rad/s/sqrt(s)
  double calibration = 0.3;                 // no unit: relative uncertainty of the scope's own motion
  double significance =
      3.0;               // standard deviations: a velocity is used from here on, until it falls below a third of that
  double jump = 8.0;     // standard deviations: a larger innovation means another target, not motion of the old one
  double damping = 0.1;  // 1/s: decay rate of the velocity
};

// Breathing that moves the target.
struct BreathingConfig {
  bool enabled = true;
  double rate = 0.0;           // Hz, set at the ventilator; 0: not known, the rate is searched
  double rate_stddev = 0.002;  // Hz, standard deviation of that rate
  HarmonicFilterConfig filter;
};

}  // namespace laparoscope_servo::servo
