// The colour gate's second look, for light that clips: a brighter lamp takes the red channel of bright tissue to its
// limit, and so changes the tissue's colour, as (4) and (5) of Bourger et al. (2007) see it, where nothing lies in
// front of it.
#pragma once

#include <vector>

#include "laparoscope_servo/image/area_grid.h"
#include "laparoscope_servo/image/colour_patch.h"

namespace laparoscope_servo::tracking {

class LightChange {
 public:
  LightChange() = default;
  // bins: of the histograms, 1 to 256. grid: of the patches.
  LightChange(int bins, const image::AreaGrid& grid);

  // Distance (2) between the histograms of an area's normalisedFeature in two patches, after the darker of the two has
  // been multiplied by the gain between them and clipped at 255 as the brighter one was. The gain is that of the
  // medians of the area's least clipped channel. NaN when that cannot be: a gain beyond 2, nothing that clips, too
  // dark, no colour, or less than half of the area valid in either.
  float distance(const image::ColourPatch& reference, const image::ColourPatch& current, int area);

 private:
  struct Pixel {
    float blue, green, red;
  };
  void collect(const image::ColourPatch& patch, int area, std::vector<Pixel>& pixels) const;
  float median(const std::vector<Pixel>& pixels, float Pixel::*channel);
  void fill(const std::vector<Pixel>& pixels, float gain, std::vector<float>& histogram) const;

  int bins_ = 0;
  image::AreaGrid grid_;
  std::vector<Pixel> reference_, current_;
  std::vector<float> channel_, histogram_, relit_;
};

}  // namespace laparoscope_servo::tracking
