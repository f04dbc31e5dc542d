// All parameters of the controller, with the defaults that config/controller.yaml repeats.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/servo/breathing.h"
#include "laparoscope_servo/servo/dead_zone.h"
#include "laparoscope_servo/servo/effect_config.h"
#include "laparoscope_servo/servo/feature_law.h"
#include "laparoscope_servo/servo/insertion_point_config.h"
#include "laparoscope_servo/servo/limiter.h"
#include "laparoscope_servo/servo/oscillation_guard.h"
#include "laparoscope_servo/servo/paper_law.h"
#include "laparoscope_servo/servo/rest_band.h"
#include "laparoscope_servo/servo/safety_config.h"
#include "laparoscope_servo/servo/target_motion.h"
#include "laparoscope_servo/servo/work_range.h"

namespace laparoscope_servo::servo {

enum class LawKind { kFeatures, kPaper };

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

// How what the poses of the shaft tell of the insertion point is used.
struct InsertionPointUse {
  bool use = true;                 // false: the calibration is taken for true, and nothing watches it
  double prior_stddev = 0.01;      // m, of the calibration, per axis; 0: it counts for nothing
  double correction_rate = 0.005;  // m/s, at which the d2 that is used goes from the calibration's to the estimate's
  InsertionPointConfig estimator;
};

// Which way is up, and what the scope's spin is for; needs the pose of the shaft.
struct HorizonConfig {
  std::vector<double> up{0.0, 0.0, 1.0};  // in the insertion point's frame, of any length but 0
};

struct ControllerConfig {
  LawKind law = LawKind::kFeatures;
  PaperGains gains;                  // of kPaper
  FeatureGains features;             // of kFeatures; desired_depth for the predictor of both
  SpinMode spin = SpinMode::kServo;  // of kFeatures
  PredictorConfig predictor;
  TargetMotionConfig target;
  BreathingConfig breathing;
  RestConfig rest;
  OscillationConfig oscillation;
  DeadZoneConfig dead_zone;
  Limits limits;
  WorkRange range;
  InsertionPointUse insertion_point;
  HorizonConfig horizon;
  EffectConfig effect;
  SafetyConfig safety;
};

// Every error, each naming the field, its value and what was expected; empty when there is none.
std::vector<std::string> validate(const ControllerConfig& config);

}  // namespace laparoscope_servo::servo
