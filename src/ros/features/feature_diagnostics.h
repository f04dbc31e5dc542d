// The diagnostics of a tracker of features.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <string>

#include "laparoscope_servo/features/tracked_feature.h"
#include "ros/tracker/feed_statistics.h"

namespace laparoscope_servo {

// `tracked`: of the newest image. `selection_error`: why what was to be selected in it was not; else empty. Level: OK
// while idle or tracking, WARN while searching, without images, or with several publishers, ERROR when lost, when the
// newest image could not be used, or nothing could be selected. A line for each feature.
void fillFeatureDiagnostics(double now, const features::TrackedFeatures& tracked, const std::string& selection_error,
                            FeedStatistics& feed, diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace laparoscope_servo
