// What the trackers of features say, as the screen shows it. Uses no ROS and no widgets.
#pragma once

#include <QPolygonF>
#include <QSize>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace laparoscope_servo::screen {

struct FeatureFact {
  std::string id;
  int kind = 0;   // of TrackedFeature
  int state = 0;  // of TrackedFeatures
  std::vector<double> parameters;
  std::vector<double> covariance;  // of the parameters, row-major; empty: not known
  double expected_error = 0.0;     // px, standard deviation; infinite or NaN: not known
  double radius = 0.0;             // m, of a POSE that is a cylinder; 0: it is none
  QPolygonF outline;               // px of the original image; empty: nothing to draw
};

// Of one image.
struct FeatureResult {
  std::int64_t stamp = 0;  // ns
  std::string frame;       // of the camera
  QSize image;             // px; empty: not known
  int state = 0;           // of TrackedFeatures
  std::string reason;
  std::vector<FeatureFact> features;
};

struct FeatureTrackerFacts {
  std::string name;  // of the node, in the cart's namespace
  bool connected = false;
  double heard_at = -1.0;                       // s of a steady clock; negative: never
  std::shared_ptr<const FeatureResult> newest;  // null: none has come
  // Of the image of the picture that is shown, or the newest of an image before that; null: there is none.
  std::shared_ptr<const FeatureResult> drawn;
};

}  // namespace laparoscope_servo::screen
