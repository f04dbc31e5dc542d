// All parameters of the controller, with the defaults that config/controller.yaml repeats.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/servo/effect_config.h"
#include "laparoscope_servo/servo/insertion_point_config.h"
#include "laparoscope_servo/servo/law_config.h"
#include "laparoscope_servo/servo/prediction_config.h"
#include "laparoscope_servo/servo/safety_config.h"
#include "laparoscope_servo/servo/shaping_config.h"

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::servo {

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
  Workspace range;
  InsertionPointUse insertion_point;
  HorizonConfig horizon;
  EffectConfig effect;
  SafetyConfig safety;
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, ControllerConfig& config);

// Every error, each naming the field, its value and what was expected; empty when there is none.
std::vector<std::string> validate(const ControllerConfig& config);

}  // namespace laparoscope_servo::servo
