// Parameters of the region tracker. Defaults are those of config/tracker.yaml.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::tracking {

// The feature of the areas' histograms, which are compared before ESM.
enum class ColourGate {
  kNone,
  kPublished,   // S0 cos H, eq. (4) and (5) of Bourger et al. (2007)
  kNormalised,  // kPublished divided by the pixel's intensity, which makes it independent of brightness
};

// Model of the change of illumination between image and reference.
enum class Light {
  kConstant,  // none: the residual is the difference of image and reference
  kGlobal,    // one gain and one bias
  kLocal,     // one gain, and a bias for each block: moving shading and shadows do not bias the estimate
};

// The channels that ESM tracks.
enum class TrackedChannels {
  kLuma,
  kStrongest,  // the mixture of colours that varies most across the ROI, without colours that clip
  // blue, green and red, without those that clip: up to three residuals per pixel, as in Bourger et al. (2007)
  kColour,
};

struct OcclusionConfig {
  ColourGate colour = ColourGate::kNormalised;
  int rows = 14;  // 14 x 14 = 196 areas in the paper
  int columns = 14;
  int bins = 32;           // m of eq. (1)
  double threshold = 0.5;  // tau_b: an area at a greater distance (2) is occluded
  bool structure = true;   // true: after ESM, areas that do not correlate with the reference also count as occluded
  int hold = 2;            // images: how long an area that failed the structure gate stays out
};

struct EsmConfig {
  int levels = 3;           // levels of the pyramid, each half the size of the last
  int max_iterations = 50;  // iterations per level
  double min_step = 0.02;   // px: converged when no corner of the ROI is expected to move by more
  Light light = Light::kLocal;
  bool robust = true;  // Tukey's weights on the residuals
  // grey levels: pixels at least this bright in a tracked colour have weight 0; 256 turns this off
  int saturation = 250;
  TrackedChannels channels = TrackedChannels::kStrongest;
};

// Limits of the acceptance tests of an estimate.
struct QualityConfig {
  // over the pixels used; the limit is higher for a ROI that correlated better before
  double min_zncc = 0.5;
  double min_visible_fraction = 0.1;  // share of the ROI's pixels used
  double min_return_fraction = 0.3;   // share of the ROI's pixels used, to be accepted again after a loss
  // px: limits of the expected standard deviation of the worst corner (not tested if block matching recognises the ROI)
  // and of the centre. The centre may be accurate where the corners are not; a user of the corners must look at
  // corner_error.
  double max_corner_error = 3.0;
  double max_centre_error = 2.5;
  double max_area_ratio = 6.0;  // largest ratio of the ROI's areas in image and reference, or of its inverse
  // share of the ROI's diagonal: allowed distance of a corner from its prediction; less if little of the ROI is visible
  double max_jump = 0.35;
  double max_search_time = 2.0;  // s: SEARCHING for longer is LOST
  // images, each at most 0.2 s after the one before, that must pass every test after a loss, before the state is
  // TRACKING again
  int confirmations = 3;
};

// Search for a lost ROI. The place of the last accepted estimate is always tried first.
struct SearchConfig {
  bool features = true;     // search by points matched with keyframes
  bool correlation = true;  // search by sliding the ROI over a coarse image (template search)
  int max_features = 600;   // points detected in an image; half as many in a keyframe
  int max_pixels = 60000;   // an image with more pixels is scaled down before points are detected
  double max_ratio = 0.85;  // distance of a point's best match over that of its second best
  int min_inliers = 8;      // least number of matches that agree
  int keyframes = 8;        // keyframes stored beside the reference
  double min_detail = 0.7;  // least correlation of the fine structure where the ROI was found
  double budget = 0.015;    // s per image, by nominal costs: the rest of the search goes on in the next image
};

struct TrackerConfig {
  OcclusionConfig occlusion;
  EsmConfig esm;
  QualityConfig quality;
  SearchConfig search;
  double velocity_damping = 0.8;  // share of the last motion that is predicted to go on
  int min_roi_side = 16;          // px
  double min_texture = 0.5;       // px: largest corner error that two grey levels of noise may cause in a ROI
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, TrackerConfig& config);

// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const TrackerConfig& config);

}  // namespace laparoscope_servo::tracking
