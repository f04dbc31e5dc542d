// Whether an estimate may be believed. One test does not do: false fits reach high correlations.
#pragma once

#include <string>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/tracking/esm.h"
#include "laparoscope_servo/tracking/tracker_config.h"

namespace laparoscope_servo::tracking {

struct Evidence {
  EsmResult esm;
  geometry::Rectangle roi;             // px, in the reference
  Eigen::Matrix3d predicted;           // G before ESM
  bool predicted_from_track = false;   // the prediction comes from the image before: the jump is judged
  double visible_fraction = 0.0;       // 0 to 1
  double zncc = 0.0;                   // over the pixels used
};

// Why the estimate is not believed, the value and the limit; empty when every test is passed.
std::string doubt(const Evidence& evidence, const QualityConfig& config);

}  // namespace laparoscope_servo::tracking
