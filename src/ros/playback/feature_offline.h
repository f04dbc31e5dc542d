// Tracks features through a file of images as fast as possible, and writes the results.
#pragma once

#include <string>

#include "laparoscope_servo/features/feature_selection.h"
#include "ros/playback/tracker_offline.h"

namespace laparoscope_servo {

struct FeatureOfflineOptions {
  OfflineOptions common;                 // without the region tracker's parameters; see feature_csv.h for the table
  std::string tracker;                   // one of featureTrackers()
  std::string params;                    // YAML file laid over config/TRACKER.yaml; empty: none
  features::FeatureSelection selection;  // in the first image; empty for trackers that find by themselves
};

// As trackOffline; the bag has TrackedFeatures on /TRACKER/features.
OfflineSummary trackFeaturesOffline(const FeatureOfflineOptions& options, const OfflineProgress& progress,
                                    const OfflineReport& report);

}  // namespace laparoscope_servo
