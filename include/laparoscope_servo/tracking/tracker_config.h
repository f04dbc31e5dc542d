// What can be set of the region tracker. Defaults are those of config/tracker.yaml.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo::tracking {

// Which feature the colour histograms of the areas are made of.
enum class AreaFeature {
  kHueSaturation,            // S0 cos H as published, eq. (4) and (5)
  kHueSaturationNormalised,  // the same divided by the pixel's intensity: bears a change of brightness
};

struct OcclusionConfig {
  bool enabled = true;
  AreaFeature feature = AreaFeature::kHueSaturation;
  int rows = 14;           // 2 to 64; 14 x 14 = 196 areas in the paper
  int columns = 14;        // 2 to 64
  int bins = 32;           // 4 to 256, m of eq. (1)
  double threshold = 0.5;  // 0 to 1, tau_b
};

struct EsmConfig {
  int levels = 3;               // 1 to 6, of the pyramid; a level twice as coarse each
  int max_iterations = 10;      // 1 to 100, per level
  double min_step = 0.02;       // px, > 0: converged when no corner of the ROI moves by more in an iteration
  bool illumination = true;     // estimate gain and bias with the motion
  int saturation = 250;         // 1 to 256 grey levels: brighter pixels (any channel) weigh nothing; 256 turns it off
};

// When an estimate is believed.
struct QualityConfig {
  double min_zncc = 0.6;              // -1 to 1
  double min_visible_fraction = 0.1;  // 0 to 1, of the ROI
  double max_area_ratio = 4.0;        // > 1: the ROI's area in the image over that in the reference, or its inverse
  double max_jump = 0.35;             // > 0, of the ROI's diagonal: how far a corner may move between images
  double min_spread = 0.02;           // 0 to 1: smallest over largest eigenvalue of the visible pixels' covariance in the ROI's frame
  double max_search_time = 2.0;       // s, > 0: SEARCHING for longer is LOST
  int confirmations = 2;              // 1 to 100: consecutive good images before SEARCHING or LOST become TRACKING again
};

struct TrackerConfig {
  OcclusionConfig occlusion;
  EsmConfig esm;
  QualityConfig quality;
  double min_roi_side = 16.0;     // px, >= 8
  double min_contrast = 2.0;      // grey levels: root mean square gradient per pixel that a ROI must have
};

// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const TrackerConfig& config);

}  // namespace laparoscope_servo::tracking
