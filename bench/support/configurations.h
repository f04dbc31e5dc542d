// Named configurations of the region tracker.
#pragma once

#include <string>

#include "laparoscope_servo/tracking/tracker_config.h"

namespace laparoscope_servo::bench {

// Every limit that can be set as lax as it goes, so that wrong estimates are seen, too. What the tracker compares with
// its own record of the ROI stays.
tracking::QualityConfig credulous();

// "none", "published" or "default"; throws std::invalid_argument for another name.
tracking::TrackerConfig configurationNamed(const std::string& name);

}  // namespace laparoscope_servo::bench
