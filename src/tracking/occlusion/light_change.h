// What the light does to the colours of a region that nothing covers, so that the colour gate compares colours as they
// would look in the light of the reference.
//
// White balance, a lamp, a veil of smoke change every area alike: a gain and an offset per channel undo that. A lamp
// that comes nearer also takes the red channel of bright tissue to its limit, which nothing undoes: what it is compared
// with is then clipped as well.
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
  // reference: has colour. bins: of the histograms, 1 to 256. grid: of the patches.
  LightChange(const image::ColourPatch& reference, int bins, const image::AreaGrid& grid);

  // The light that is known from images before; at first, that of the reference.
  const ColourLight& known() const { return known_; }
  // What was found for the current image has turned out to be true.
  void learn(const ColourLight& light) { known_ = light; }

  // Before propose(): the current image, which has colour.
  void look(const image::ColourPatch& current) { colours_.compute(current, grid_); }

  // A light that explains the image better than the known one may. By the areas that agree with that one, as an
  // occluder leaves them as they are.
  std::optional<ColourLight> follow(const std::vector<char>& agree) { return propose(agree, &known_, -1.0); }
  // By what more than half of the areas agree on, and differ by from each other: all have changed at once.
  std::optional<ColourLight> find() { return propose(all_, nullptr, kLeastCorrelation); }

  // Distance (2) between the histograms of an area's normalisedFeature in both images, the current one in `light` and
  // in the area's own gain beyond it, each clipped where the other one is. That gain is the ratio of the medians of the
  // area's least bright channel. NaN when clipping cannot account for another colour: a gain beyond 2.5, hardly
  // anything that clips, too dark, or less than half of the area valid in either.
  float clippedDistance(const image::ColourPatch& current, const ColourLight& light, int area);

 private:
  // Of a channel's values, or what else there is for each channel.
  using Colour = std::array<float, 3>;  // blue, green, red
  // Of an area's valid pixels.
  float clippedShare(const image::ColourPatch& patch, int area) const;
  void collect(const image::ColourPatch& patch, const ColourLight& light, int area, std::vector<Colour>& pixels) const;
  float median(const std::vector<Colour>& pixels, int channel);
  void fill(const std::vector<Colour>& pixels, float gain, const Colour& ceiling, std::vector<float>& histogram) const;
  std::optional<ColourLight> propose(const std::vector<char>& use, const ColourLight* start, double least_correlation);

  // Of an occluder's shading with the region's, which is chance; of a region's with its own, hardly less than one.
  static constexpr double kLeastCorrelation = 0.8;

  int bins_ = 0;
  image::AreaGrid grid_;
  image::ColourPatch reference_;
  AreaColours reference_colours_, colours_;
  LightFit fit_;
  ColourLight known_;
  std::vector<char> all_;
  std::vector<Colour> before_, now_;
  std::vector<float> channel_, histogram_, relit_;
  std::vector<float> reference_clipped_;  // share of each area
};

}  // namespace laparoscope_servo::tracking
