// What can be set of the region tracker. Defaults are those of config/tracker.yaml.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::tracking {

// What the histograms of the areas are made of, before ESM.
enum class ColourGate {
  kNone,
  kPublished,   // S0 cos H, eq. (4) and (5) of Bourger et al. (2007)
  kNormalised,  // the same divided by the pixel's intensity: bears changes of brightness
};

// How the light of the image and that of the reference are related.
enum class Light {
  kConstant,  // not at all: the residual is their difference
  kGlobal,    // one gain, one bias
  kLocal,     // one gain, a bias for each block of 16 x 16 px: shading and shadows that move do not pull the estimate
};

// What of the colours ESM tracks.
enum class TrackedChannels {
  kLuma,
  kStrongest,  // the mixture that varies most across the ROI, of colours that do not clip
  kColour,     // blue, green and red, but what clips: three residuals a pixel, as Bourger et al. (2007) extend ESM
};

struct OcclusionConfig {
  ColourGate colour = ColourGate::kNormalised;
  int rows = 14;  // 14 x 14 = 196 areas in the paper
  int columns = 14;
  int bins = 32;           // m of eq. (1)
  double threshold = 0.5;  // tau_b: an area at a greater distance (2) is occluded
  bool structure = true;   // after ESM, areas that do not correlate with the reference are occluded, too
  int hold = 2;            // images: how long an area that failed the structure gate stays out
};

struct EsmConfig {
  int levels = 3;           // of the pyramid; a level twice as coarse each
  int max_iterations = 50;  // per level
  double min_step = 0.02;   // px: converged when no corner of the ROI is expected to move by more
  Light light = Light::kLocal;
  bool robust = true;    // Tukey's weights on the residuals
  int saturation = 250;  // grey levels: pixels as bright as this in a colour that is tracked weigh nothing;
                         // 256 turns it off
  TrackedChannels channels = TrackedChannels::kStrongest;
};

// When an estimate is believed.
struct QualityConfig {
  double min_zncc = 0.5;              // over the pixels used; the tracker asks for more of a ROI that was better
  double min_visible_fraction = 0.1;  // share of the ROI's pixels used
  double min_return_fraction = 0.3;   // the same to be believed again after a loss
  // px: standard deviations expected of the worst corner, where block matching does not say that it is the
  // ROI, and of the centre. The centre may be known where the corners are not: who needs them looks at corner_error.
  double max_corner_error = 3.0;
  double max_centre_error = 2.5;
  double max_area_ratio = 6.0;   // area of the ROI in the image over that in the reference, or its inverse
  double max_jump = 0.35;        // of the ROI's diagonal: how far a corner may be from its prediction; less when
                                 // little of the ROI is visible
  double max_search_time = 2.0;  // s: SEARCHING for longer is LOST
  int confirmations = 3;         // images in a row that pass every test, before TRACKING is said again
};

// Where to look for the ROI when it was lost. After the place where it was seen last, which is always tried.
struct SearchConfig {
  bool features = true;     // by points matched with stored views
  bool correlation = true;  // by sliding the ROI over a coarse image
  int max_features = 600;   // points drawn from an image; half of it from a stored view
  int max_pixels = 60000;   // an image with more is scaled down before points are drawn
  double max_ratio = 0.85;  // distance of a point's best match over that of its second best
  int min_inliers = 8;      // matches that agree
  int keyframes = 8;        // views stored beside the reference
  double min_detail = 0.7;  // correlation of the fine structure, where it was found
  double budget = 0.015;    // s, by nominal costs: what does not fit is left for the next image
};

struct TrackerConfig {
  OcclusionConfig occlusion;
  EsmConfig esm;
  QualityConfig quality;
  SearchConfig search;
  double velocity_damping = 0.8;  // share of the last motion that is expected to go on
  int min_roi_side = 16;          // px
  double min_texture = 0.5;       // px: corner error that two grey levels of noise may cause in a ROI
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, TrackerConfig& config);

// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const TrackerConfig& config);

}  // namespace laparoscope_servo::tracking
