#include "laparoscope_servo/tracking/tracker_config.h"

#include "laparoscope_servo/validation/range_checker.h"

namespace laparoscope_servo::tracking {

std::vector<std::string> validate(const TrackerConfig& c) {
  validation::RangeChecker check;
  check.range("occlusion/rows", c.occlusion.rows, 2, 64);
  check.range("occlusion/columns", c.occlusion.columns, 2, 64);
  check.range("occlusion/bins", c.occlusion.bins, 4, 256);
  check.range("occlusion/threshold", c.occlusion.threshold, 0.0, 1.0);
  check.range("occlusion/hold", c.occlusion.hold, 0, 100);
  check.range("esm/levels", c.esm.levels, 1, 6);
  check.range("esm/max_iterations", c.esm.max_iterations, 1, 100);
  check.range("esm/min_step", c.esm.min_step, 0.0001, 1.0);
  check.range("esm/saturation", c.esm.saturation, 1, 256);
  check.range("quality/min_zncc", c.quality.min_zncc, 0.0, 1.0);
  check.range("quality/min_visible_fraction", c.quality.min_visible_fraction, 0.0, 1.0);
  check.range("quality/min_return_fraction", c.quality.min_return_fraction, 0.0, 1.0);
  check.range("quality/max_corner_error", c.quality.max_corner_error, 0.01, 100.0);
  check.range("quality/max_centre_error", c.quality.max_centre_error, 0.01, 100.0);
  check.range("quality/max_area_ratio", c.quality.max_area_ratio, 1.01, 1000.0);
  check.range("quality/max_jump", c.quality.max_jump, 0.01, 10.0);
  check.range("quality/max_search_time", c.quality.max_search_time, 0.0, 3600.0);
  check.range("quality/confirmations", c.quality.confirmations, 1, 100);
  check.range("search/max_features", c.search.max_features, 50, 5000);
  check.range("search/max_pixels", c.search.max_pixels, 10000, 10000000);
  check.range("search/max_ratio", c.search.max_ratio, 0.1, 1.0);
  check.range("search/min_inliers", c.search.min_inliers, 4, 1000);
  check.range("search/keyframes", c.search.keyframes, 0, 64);
  check.range("search/min_detail", c.search.min_detail, 0.0, 1.0);
  check.range("search/budget", c.search.budget, 0.001, 10.0, "s");
  check.range("velocity_damping", c.velocity_damping, 0.0, 1.0);
  check.range("min_roi_side", c.min_roi_side, 8, 1000);
  check.range("min_texture", c.min_texture, 0.01, 10.0);
  return check.errors();
}

}  // namespace laparoscope_servo::tracking
