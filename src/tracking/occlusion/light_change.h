// Estimates the change of illumination between reference and image, so that the colour gate compares colours as they
// would look under the reference's illumination.
//
// White balance, the lamp and a veil of smoke change all areas alike: a gain and an offset per channel undo that. A
// lamp that comes nearer also saturates the red channel of bright tissue, which cannot be inverted; the other image is
// then clipped too before both are compared.
#pragma once

#include <optional>
#include <vector>

#include "laparoscope_servo/image/area_grid.h"
#include "laparoscope_servo/image/colour_patch.h"
#include "tracking/occlusion/light_fit.h"

namespace laparoscope_servo::tracking {

class LightChange {
 public:
  LightChange() = default;
  // reference: must have colour. bins: number of bins of the histograms, 1 to 256. grid: the areas of the patches.
  LightChange(const image::ColourPatch& reference, int bins, const image::AreaGrid& grid);

  // The last accepted illumination; at first, that of the reference.
  const ColourLight& known() const { return known_; }
  // Accepts the illumination that was found for the current image.
  void learn(const ColourLight& light) { known_ = light; }

  // Call before follow() or find(): sets the current image, which must have colour.
  void look(const image::ColourPatch& current) { colours_.compute(current, grid_); }

  // Estimates the illumination from the areas that agree under the known one, since an occluder does not change those.
  // Empty if there is no estimate, or if it hardly differs from the known one.
  std::optional<ColourLight> follow(const std::vector<char>& agree) { return propose(agree, &known_, -1.0); }
  // Estimates an illumination change that more than half of the areas share, when all changed at once. The means of the
  // areas must correlate between both images.
  std::optional<ColourLight> find() { return propose(all_, nullptr, kLeastCorrelation); }

  // Distance (2) between the histograms of an area's normalisedFeature in both images, both clipped at the lower of
  // their saturation levels. The current image is first corrected by `light`, the darker one then by the area's own
  // gain, the ratio of the medians of the area's least bright channel. NaN when clipping cannot explain a difference in
  // colour: the gain is above 2.5, hardly any pixel clips, the area is too dark, or less than half of it is valid in
  // either image.
  float clippedDistance(const image::ColourPatch& current, const ColourLight& light, int area);

 private:
  // One value for each channel.
  using Colour = std::array<float, 3>;  // blue, green, red
  // Share of an area's valid pixels that clip in any channel.
  float clippedShare(const image::ColourPatch& patch, int area) const;
  struct Medians {
    Colour colour = {};
    int pixels = 0;  // valid ones
  };
  // Of an area's valid pixels under `light`, channel by channel.
  Medians medians(const image::ColourPatch& patch, const ColourLight& light, int area) const;
  void fill(const image::ColourPatch& patch, const ColourLight& light, int area, float gain, const Colour& ceiling,
            std::vector<float>& histogram) const;
  std::optional<ColourLight> propose(const std::vector<char>& use, const ColourLight* start, double least_correlation);

  // Least correlation of the areas' means in both images: that of an occluder's shading with the region's is random,
  // that of a region with itself is close to one.
  static constexpr double kLeastCorrelation = 0.8;

  int bins_ = 0;
  image::AreaGrid grid_;
  image::ColourPatch reference_;
  AreaColours reference_colours_, colours_;
  LightFit fit_;
  ColourLight known_;
  std::vector<char> all_;
  std::vector<float> histogram_, relit_;
  std::vector<float> reference_clipped_;    // clippedShare() of each area of the reference
  std::vector<Medians> reference_medians_;  // of the same
};

}  // namespace laparoscope_servo::tracking
