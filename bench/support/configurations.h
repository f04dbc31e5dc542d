// Named configurations of the region tracker.
#pragma once

#include <string>

#include "laparoscope_servo/tracking/tracker_config.h"

namespace laparoscope_servo::bench {

// Believes nearly every estimate, so that wrong ones are seen, too.
tracking::QualityConfig credulous();

// "none", "published" or "default"; throws std::invalid_argument for another name.
tracking::TrackerConfig configurationNamed(const std::string& name);

}  // namespace laparoscope_servo::bench
