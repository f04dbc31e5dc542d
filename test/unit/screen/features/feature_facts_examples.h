// Features for the tests of what shows them, as messages and as facts.
#pragma once

#include <laparoscope_servo/TrackedFeatures.h>

#include <cmath>
#include <memory>
#include <string>

#include "screen/features/feature_result.h"

namespace laparoscope_servo::screen::test_support {

// From (100, 60) to (300, 60) px: rho = 60, theta = 90 degrees.
inline TrackedFeature lineMessage(const std::string& id = "shaft") {
  TrackedFeature line;
  line.id = id;
  line.kind = TrackedFeature::LINE;
  line.state = TrackedFeatures::TRACKING;
  line.parameters = {60.0, M_PI / 2};
  line.covariance = {16.0, 0.0, 0.0, 0.0};
  line.expected_error = 4.0;
  line.outline = {100.0, 60.0, 300.0, 60.0};
  return line;
}

inline TrackedFeature pointMessage(const std::string& id, double u, double v) {
  TrackedFeature point;
  point.id = id;
  point.kind = TrackedFeature::POINT;
  point.state = TrackedFeatures::TRACKING;
  point.parameters = {u, v};
  point.covariance = {25.0, 0.0, 0.0, 100.0};
  point.expected_error = 10.0;
  point.outline = {u, v};
  return point;
}

inline TrackedFeatures featuresMessage(double stamp, const std::vector<TrackedFeature>& features) {
  TrackedFeatures message;
  message.header.stamp = ros::Time(stamp);
  message.header.frame_id = "camera";
  message.state = TrackedFeatures::IDLE;
  if (!features.empty()) message.state = features.front().state;
  message.reason = features.empty() ? "nothing is selected" : "";
  message.features = features;
  return message;
}

}  // namespace laparoscope_servo::screen::test_support
