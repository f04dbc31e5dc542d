// The trackers of features by their names, as nodelets, tools and pages know them.
#pragma once

#include <XmlRpcValue.h>

#include <memory>
#include <string>
#include <vector>

#include "laparoscope_servo/features/feature_tracker.h"
#include "ros/features/feature_parameters.h"

namespace laparoscope_servo {

// In the order in which people are told of them.
std::vector<std::string> featureTrackers();

// The tracker `kind`, by the parameters of `tree`, which is named `name` in errors; `input` gets those that all kinds
// share. Every error is appended to `errors`; with any there is no tracker. Throws std::invalid_argument for a kind
// that is none.
std::unique_ptr<features::FeatureTracker> makeFeatureTracker(const std::string& kind, const XmlRpc::XmlRpcValue& tree,
                                                             const std::string& name, FeatureInput& input,
                                                             std::vector<std::string>& errors);

}  // namespace laparoscope_servo
