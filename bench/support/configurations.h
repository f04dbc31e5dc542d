// Named configurations of the region tracker.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/tracking/tracker_config.h"

namespace laparoscope_servo::bench {

// Every limit that can be set as lax as it goes, so that wrong estimates are seen, too. What the tracker compares with
// its own record of the ROI stays.
tracking::QualityConfig credulous();

// "none", "published" or "default"; throws std::invalid_argument for another name. The first two have no model of light
// either: they are the paper's.
tracking::TrackerConfig configurationNamed(const std::string& name);

struct NamedConfig {
  std::string name;
  tracking::TrackerConfig config;
};

// The default with each part of the detection of occlusions alone, and together: "none", "published", "colour",
// "structure", "robust" (weights alone), "colour+structure", "default" (both with robust weights).
std::vector<NamedConfig> gateConfigurations();

}  // namespace laparoscope_servo::bench
