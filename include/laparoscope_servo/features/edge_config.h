// What can be set of the trackers of edges: line, ellipse, spline.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/features/feature_state.h"

namespace laparoscope_servo::features {

struct EdgeConfig {
  double spacing = 4.0;            // px from site to site
  int max_sites = 200;             // a longer curve has them further apart
  double range = 20.0;             // px along the normal, either side of where the curve is expected
  double min_contrast = 8.0;       // grey levels across an edge; less is noise
  double min_similarity = 0.4;     // of an edge's contrast to the one remembered: the smaller over the larger
  double min_share = 0.3;          // of the sites in the image, that agree with the curve
  double min_return_share = 0.35;  // the same to be believed again after a loss
  double max_error = 1.5;          // px: expected of the worst site
  double max_change = 0.2;         // of size or shape, from one image to the next
  double velocity_damping = 0.8;   // share of the last motion that is expected to go on
  StateConfig state;
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, EdgeConfig& config);

// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const EdgeConfig& config);

}  // namespace laparoscope_servo::features
