// The task error of an instrument's tip, from what the nodelet Instrument says: the input of the task CENTRE_TIP.
#pragma once

#include <laparoscope_servo/TrackedFeatures.h>

#include <string>

#include "laparoscope_servo/servo/task_config.h"
#include "laparoscope_servo/servo/task_error_input.h"
#include "ros/controller/feature_camera.h"

namespace laparoscope_servo {

// Keeps to one instrument: the one whose tip was nearest to the zone's middle when it was chosen. It takes no other one
// until release().
class TipInput {
 public:
  explicit TipInput(const servo::CentreTipConfig& config) : config_(config) {}

  // Not valid unless that instrument's tip is TRACKING; `problem` says what is wrong with the message or the camera.
  // The caller fills in the ages.
  servo::TaskErrorInput from(const TrackedFeatures& message, const FeatureCamera& camera);

  // The next message may choose another instrument.
  void release() { chosen_.clear(); }

 private:
  const TrackedFeature* choose(const TrackedFeatures& message, const FeatureCamera& camera);
  double distanceOf(const TrackedFeature& tip, const FeatureCamera& camera) const;

  servo::CentreTipConfig config_;
  std::string chosen_;   // id of the feature; empty: none
  double number_ = 0.0;  // of choices, which tells one from the next
};

}  // namespace laparoscope_servo
