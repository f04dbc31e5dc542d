// Decides, with both gates, which pixels of the region of interest (ROI) drive ESM in an image. Colour distances are
// those of colour_gate.h, structure distances those of structure_gate.h; this class compares them with the thresholds.
//
// The colour gate decides before ESM and afresh in each image. The structure gate decides after ESM: what it rejects
// stays out for the next images, too, so that an occluder that moves on does not pull the estimate with it.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/image/area_grid.h"
#include "laparoscope_servo/tracking/area_report.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "tracking/occlusion/colour_gate.h"
#include "tracking/occlusion/highlight_mask.h"
#include "tracking/occlusion/light_change.h"
#include "tracking/occlusion/structure_gate.h"

namespace laparoscope_servo::tracking {

// The step, in rows and columns, at which an ROI of this size is sampled for its areas' histograms: 1 for every pixel,
// 2 for every second, ...
int samplingStep(const cv::Size& size, const OcclusionConfig& config);

class OcclusionGates {
 public:
  OcclusionGates(const OcclusionConfig& config, int saturation);

  // `patch`: every samplingStep-th pixel of the reference's ROI, which has `size` px. `tracked`: the channels (blue,
  // green, red) to which the constructor's saturation applies. Throws std::invalid_argument when the patch is of
  // another size, or the ROI has fewer pixels than areas in a direction.
  void setReference(const image::ColourPatch& patch, const cv::Size& size,
                    const std::array<bool, 3>& tracked = {true, true, true});

  // After setReference(): what is not 0 in `covered`, which has the size of that patch, is never used.
  void hideInReference(const cv::Mat1b& covered) { highlights_.hideInReference(covered); }

  // Call before ESM. `patch`: the current image at the expected place of the ROI, sampled with the same step, see
  // image::warpNearest. If areas differ in colour, the current illumination is estimated and the colours are compared
  // as they would look under that of the reference (see LightChange); otherwise the last known illumination is used.
  void observeColour(const image::ColourPatch& patch);

  // Call after ESM. `channels`: the warped image and the reference in one channel or several. `valid`: 1 where the
  // warped image is valid, else 0. `gain`: that of ESM. `sigma`: standard deviation of the residual [grey levels].
  // Returns how many areas that drove ESM turned out to be occluded.
  int observeStructure(const PatchPair* channels, int count, const image::Patch& valid, double gain, double sigma);

  // Zero-mean normalised cross-correlation at the last observeStructure(), over the areas that are not occluded, -1 to
  // 1; 0 when there is nothing to compare. Each area's own mean is subtracted, so that light and shade do not raise it.
  double correlation() const;
  // Share of the ROI's pixels that correlation() uses, 0 to 1.
  double visibleFraction() const;

  // See OcclusionConfig::threshold; from the next image on.
  void setThreshold(double threshold) { config_.threshold = threshold; }

  // Forgets what the structure gate rejected: the place has changed.
  void forget();

  // Call once at the end of each image: counts down how long rejected areas stay out.
  void advance();

  // 1 for the ROI's pixels that may drive ESM, else 0: area not occluded, in the image, not saturated in it or the
  // reference.
  const image::Patch& weights();

  // Gain that takes the image's illumination to the reference's, by the colours, mean of the channels; 0 if the colours
  // show no change of illumination.
  double lightGain() const;

  // False when the image has no colour, or the gate is off: the colour gate is then inactive.
  bool colourUsed() const { return colour_used_; }
  bool occluded(int area) const { return colour_rejects_[area] || held_[area] > 0; }
  // Occluded, or most of it is not valid: outside of the image, or covered by what patches leave out.
  bool covered(int area) const { return occluded(area) || highlights_.hidden(area) == AreaCause::kBorder; }
  // All areas, with their causes, for display only: no decision depends on it. Keeps the memory of `areas`.
  void report(AreaReport& areas) const;
  const std::vector<float>& distances() const { return distances_; }
  const image::AreaGrid& grid() const { return grid_; }

 private:
  bool rejectByColour();
  bool explains(const std::vector<float>& distances, bool by_all) const;
  void accountForLight(const image::ColourPatch& patch);
  void forgiveClipping(const image::ColourPatch& patch);
  void learnLight(double gain, double sigma);

  OcclusionConfig config_;
  HighlightMask highlights_;
  image::AreaGrid grid_;
  ColourHistograms reference_;
  ColourHistograms current_;
  LightChange light_change_;
  ColourLight light_;  // illumination of the current image, by its colours
  bool reference_has_colour_ = false;
  bool colour_used_ = false;
  image::AreaGrid samples_;       // the areas in the sampled patches
  std::vector<float> distances_;  // eq. (2) of each area
  std::vector<float> relit_distances_;
  std::vector<char> colour_rejects_;  // 1 if the colour gate rejects the area in this image
  // 1 if the area's distance under the last known illumination is within the threshold
  std::vector<char> agree_;
  int agreed_before_ = 0;  // areas that agreed after the last illumination estimate, or later if more
  std::vector<int> held_;  // images for which the structure gate still rejects the area
  StructureStatistics statistics_;
  image::Patch unsaturated_;  // 1 where the aligned image is valid and neither it nor the reference saturated
  std::vector<float> areas_;
  image::Patch weights_;
};

}  // namespace laparoscope_servo::tracking
