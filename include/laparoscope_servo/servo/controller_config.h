// All parameters of the controller, with the defaults that config/controller.yaml repeats.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/servo/effect_config.h"
#include "laparoscope_servo/servo/insertion_point_config.h"
#include "laparoscope_servo/servo/law_config.h"
#include "laparoscope_servo/servo/leash_config.h"
#include "laparoscope_servo/servo/prediction_config.h"
#include "laparoscope_servo/servo/safety_config.h"
#include "laparoscope_servo/servo/shaping_config.h"
#include "laparoscope_servo/servo/task_config.h"

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::servo {

// Use of the insertion point that is estimated from the poses of the shaft.
struct InsertionPointUse {
  bool use = true;                 // false: the calibration is used as it is, and is not monitored
  double prior_stddev = 0.01;      // m, of the calibration, per axis; 0: no prior
  double correction_rate = 0.005;  // m/s, rate at which the d2 used moves from the calibration's to the estimate's
  InsertionPointConfig estimator;
};

// The direction "up" for SpinMode::kUpright, which needs the pose of the shaft.
struct HorizonConfig {
  std::vector<double> up{0.0, 0.0, 1.0};  // in the insertion point's frame, of any length but 0
};

struct ControllerConfig {
  LawKind law = LawKind::kFeatures;
  PaperGains gains;                  // for the law kPaper
  FeatureGains features;             // for the law kFeatures; desired_depth also for the predictor of both laws
  SpinMode spin = SpinMode::kServo;  // for the law kFeatures
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
  StabiliseConfig stabilise;
  CentreTipConfig centre_tip;
  FollowConfig follow;
  PointsConfig points;
  EffectConfig effect;
  LeashConfig leash;
  SafetyConfig safety;
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, ControllerConfig& config);

// Every error, each naming the field, its value and what was expected; empty when there is none.
std::vector<std::string> validate(const ControllerConfig& config);

}  // namespace laparoscope_servo::servo
