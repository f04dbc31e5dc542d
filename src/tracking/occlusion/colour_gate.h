// Colour distances of the areas of the region of interest (ROI), to find occluders: section II of Bourger et al.
// (2007).
//
// Each area's histogram (1) of a colour feature is compared with that of the reference by the Bhattacharyya distance
// (2); OcclusionGates takes an area at a distance above tau_b for occluded. Works on the ROI's patch, warped by the
// predicted homography, before ESM.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/image/area_grid.h"
#include "laparoscope_servo/image/colour_patch.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "tracking/occlusion/light_fit.h"

namespace laparoscope_servo::tracking {

// Eq. (4) with (5): S0 cos H, in [-255, 255] for components in [0, 255]; 0 for grey pixels, where H is not defined.
float hueSaturationFeature(float r, float g, float b);

// hueSaturationFeature() divided by the mean of r, g and b, so that the lamp's brightness cancels; in [-1.5, 3]. Dark
// pixels, whose colour is noise, go towards 0.
float normalisedFeature(float r, float g, float b);

// The bin of a value of normalisedFeature among `bins` over its range, from 0.
int normalisedBin(float feature, int bins);

// Eq. (2) and (3), in [0, 1]: 0 for equal histograms, 1 for histograms without a common bin. Both sum to 1.
float bhattacharyyaDistance(const float* a, const float* b, int bins);

class ColourHistograms {
 public:
  ColourHistograms(ColourGate mode, int bins) : mode_(mode), bins_(bins) {}

  // `patch` has colour and the grid's size; pixels with valid = 0 do not count. `light` is applied to the colours
  // first, and the result clamped to 0 to 255.
  void compute(const image::ColourPatch& patch, const image::AreaGrid& grid, const ColourLight& light = {});

  // The area's histogram, eq. (1), `bins` numbers that sum to 1 when pixels(area) > 0.
  const float* histogram(int area) const { return histograms_.data() + static_cast<std::size_t>(area) * bins_; }
  // Number of pixels in the area's histogram.
  int pixels(int area) const { return pixels_[area]; }

 private:
  ColourGate mode_;
  int bins_;
  std::vector<int> counts_;  // like histograms_
  std::vector<int> bin_of_;  // of a row's pixels
  std::vector<float> histograms_;
  std::vector<int> pixels_;
};

// Distance (2) per area; NaN for an area of which less than half is valid in either.
void areaDistances(const ColourHistograms& reference, const ColourHistograms& current, const image::AreaGrid& grid,
                   int bins, std::vector<float>& distances);

}  // namespace laparoscope_servo::tracking
