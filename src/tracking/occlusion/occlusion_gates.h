// Both gates together, over time: which pixels of the region of interest (ROI) drive ESM in an image.
//
// The colour gate decides before ESM and afresh in each image. The structure gate decides after ESM: what it rejects
// stays out for the next images, too, so that an occluder that moves on does not pull the estimate with it.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/image/area_grid.h"
#include "laparoscope_servo/tracking/area_cause.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "tracking/occlusion/colour_gate.h"
#include "tracking/occlusion/light_change.h"
#include "tracking/occlusion/structure_gate.h"

namespace laparoscope_servo::tracking {

// Of the pixels of an ROI of this size, in rows and columns, so many as its areas' histograms need: each, every second,
// ...
int samplingStep(const cv::Size& size, const OcclusionConfig& config);

class OcclusionGates {
 public:
  OcclusionGates(const OcclusionConfig& config, int saturation);

  // The reference's ROI, `size` px, every samplingStep-th pixel of which is in the patch. Of the constructor's
  // saturation, `tracked` says for which of the channels, blue, green and red, it counts. Throws std::invalid_argument
  // when the patch is of another size, or the ROI has fewer pixels than areas in a direction.
  void setReference(const image::ColourPatch& patch, const cv::Size& size,
                    const std::array<bool, 3>& tracked = {true, true, true});

  // Before ESM: `patch` is the ROI, sampled likewise, as the current image shows it where it is expected, see
  // image::warpNearest. Colours are compared in the light of the reference: see LightChange.
  void observeColour(const image::ColourPatch& patch);

  // After ESM: the warped image and the reference, in one channel or several, where the former is valid (1, else 0),
  // the gain that brings it to the reference's light, and the standard deviation of the residual [grey levels]. Returns
  // how many areas that drove ESM turned out to be occluded.
  int observeStructure(const PatchPair* channels, int count, const image::Patch& valid, double gain, double sigma);

  // Of the last observeStructure: the zero-mean normalised cross-correlation over the areas that are not occluded, -1
  // to 1, each area's own means taken out; 0 when there is nothing to compare. Light and shade do not raise it.
  double correlation() const;
  // Share of the ROI's pixels that are used in those areas, 0 to 1.
  double visibleFraction() const;

  // See OcclusionConfig::threshold; from the next image on.
  void setThreshold(double threshold) { config_.threshold = threshold; }

  // Forgets what the structure gate rejected: the place has changed.
  void forget();

  // Called once when an image is done: time passes for what is held.
  void advance();

  // 1 for the ROI's pixels that may drive ESM, else 0: area not occluded, in the image, not saturated in it or the
  // reference.
  const image::Patch& weights();

  // Of the channels on average, the gain of the image's light against that of the reference; 0 where the colours show
  // the same light.
  double lightGain() const;

  // False when the image has no colour, or the gate is off: the colour gate then stands aside.
  bool colourUsed() const { return colour_used_; }
  bool occluded(int area) const { return colour_rejects_[area] || held_[area] > 0; }
  // Of every area, for people: nothing is decided by it.
  void causes(std::vector<AreaCause>& causes) const;
  const std::vector<float>& distances() const { return distances_; }
  const image::AreaGrid& grid() const { return grid_; }

 private:
  void markSaturated(const image::ColourPatch& patch, cv::Mat1b& mask) const;
  bool rejectByColour();
  bool explains(const std::vector<float>& distances, bool by_all) const;
  void accountForLight(const image::ColourPatch& patch);
  void forgiveClipping(const image::ColourPatch& patch);
  void learnLight(double gain, double sigma);
  void spread(const cv::Mat1b& saturated, const cv::Mat1b& valid);
  AreaCause hidden(int row, int column) const;

  OcclusionConfig config_;
  int saturation_;
  std::array<int, 3> limits_ = {256, 256, 256};  // grey levels, of each channel
  image::AreaGrid grid_;
  ColourHistograms reference_;
  ColourHistograms current_;
  LightChange light_change_;
  ColourLight light_;  // of this image, as the colours show it
  bool reference_has_colour_ = false;
  bool colour_used_ = false;
  int step_ = 1;
  image::AreaGrid samples_;                    // of the patches
  cv::Mat1b reference_saturated_, saturated_;  // 255 or 0 per sample
  cv::Mat1b valid_;                            // 255 per sample in the image, or 0
  image::Patch usable_;           // 1 per pixel of the ROI, or 0: saturated in image or reference, or not valid
  std::vector<float> distances_;  // (2) per area
  std::vector<float> relit_distances_;
  std::vector<char> colour_rejects_;  // per area, in this image
  std::vector<char> agree_;           // per area: not so in the light that is known
  int agreed_before_ = 0;             // areas, after the last look for another light, or more since
  std::vector<int> held_;             // per area: images for which the structure gate keeps it out
  StructureStatistics statistics_;
  image::Patch unsaturated_;  // 1 where the aligned image is valid and neither it nor the reference saturated
  std::vector<float> row_, areas_;
  image::Patch weights_;
};

}  // namespace laparoscope_servo::tracking
