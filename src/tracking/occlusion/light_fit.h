// The light of an image's channels against that of the reference: white balance, a lamp, a veil of smoke.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "laparoscope_servo/image/area_grid.h"
#include "laparoscope_servo/image/colour_patch.h"

namespace laparoscope_servo::tracking {

// reference = gain * image + offset, in grey levels.
struct ChannelLight {
  float gain = 1.0f;
  float offset = 0.0f;
};
using ColourLight = std::array<ChannelLight, 3>;  // blue, green, red

// Grey levels by which the two differ at most, over all values of an image's pixel.
float largestDifference(const ColourLight& a, const ColourLight& b);

// Mean colour of each area of a patch, blue, green, red; NaN where it tells nothing: clipped in the channel, or less
// than half of it valid.
class AreaColours {
 public:
  void compute(const image::ColourPatch& patch, const image::AreaGrid& grid);
  float mean(int channel, int area) const { return means_[channel][area]; }
  int count() const { return static_cast<int>(means_[0].size()); }

 private:
  std::array<std::vector<float>, 3> means_;
};

// Fits a line per channel to the means of the areas; those that do not agree with the others in all channels have no
// weight.
class LightFit {
 public:
  explicit LightFit(int areas = 0);

  struct Result {
    ColourLight light;
    double correlation;  // -1 to 1, between both images' areas that have a weight, mean over the channels
  };
  // From the areas with use[area] != 0. `start`: a light that these agree with, null when none is known; then more than
  // half of them have to agree. Nothing when too few tell something, or what is found is not what light does.
  std::optional<Result> fit(const AreaColours& image, const AreaColours& reference, const std::vector<char>& use,
                            const ColourLight* start);

 private:
  ChannelLight commonGain(const AreaColours& image, const AreaColours& reference, int channel,
                          const std::vector<char>& use);
  void weigh(const AreaColours& image, const AreaColours& reference, const std::vector<char>& use,
             const ColourLight& light);

  std::vector<float> weights_, distances_, values_;
};

}  // namespace laparoscope_servo::tracking
