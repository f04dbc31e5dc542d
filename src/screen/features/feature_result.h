// TrackedFeatures as the screen keeps it.
#pragma once

#include <laparoscope_servo/TrackedFeatures.h>

#include <memory>

#include "screen/features/feature_facts.h"

namespace laparoscope_servo::screen {

// What cannot be drawn is left out: an outline with a point that is not finite or far away, a covariance that is not
// that of the parameters or not finite. Of a message with too many features or points only the first ones.
std::shared_ptr<const FeatureResult> featureResult(const TrackedFeatures& message);

}  // namespace laparoscope_servo::screen
