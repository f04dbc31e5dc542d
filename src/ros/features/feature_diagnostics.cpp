#include "ros/features/feature_diagnostics.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <cstdio>

namespace laparoscope_servo {

namespace {

using diagnostic_msgs::DiagnosticStatus;
using features::State;

unsigned char levelOf(State state) {
  if (state == State::kSearching) return DiagnosticStatus::WARN;
  return state == State::kLost ? DiagnosticStatus::ERROR : DiagnosticStatus::OK;
}

std::string withReason(State state, const std::string& reason) {
  return features::stateName(state) + (reason.empty() ? "" : ": " + reason);
}

std::string text(const features::TrackedFeature& feature) {
  char numbers[64];
  std::snprintf(numbers, sizeof(numbers), ", share %.2f, expected error %.3f px", feature.share,
                feature.expected_error);
  return std::string(features::kindName(feature.kind)) + ", " + withReason(feature.state, feature.reason) + numbers;
}

}  // namespace

void fillFeatureDiagnostics(double now, const features::TrackedFeatures& tracked, const std::string& selection_error,
                            FeedStatistics& feed, diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::string state = withReason(tracked.state, tracked.reason);
  if (!feed.summariseMissing(now, state, status)) {
    status.summary(levelOf(tracked.state), state);
    if (!selection_error.empty())
      status.mergeSummary(DiagnosticStatus::ERROR, "nothing was selected: " + selection_error);
  }
  feed.warnOfPublishers(status);
  status.add("state", features::stateName(tracked.state));
  status.add("reason", tracked.reason);
  feed.fill(now, status);
  for (const features::TrackedFeature& feature : tracked.features) status.add("feature " + feature.id, text(feature));
}

}  // namespace laparoscope_servo
