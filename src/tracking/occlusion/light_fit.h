// Fits the illumination of an image, channel by channel, to that of the reference: white balance, lamp, a veil of
// smoke.
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

// Largest difference [grey levels] between what both make of a pixel, over all pixel values.
float largestDifference(const ColourLight& a, const ColourLight& b);

// Mean colour of each area of a patch, blue, green, red; NaN if the area clips in the channel, or if less than half of
// it is valid.
class AreaColours {
 public:
  void compute(const image::ColourPatch& patch, const image::AreaGrid& grid);
  float mean(int channel, int area) const { return means_[channel][area]; }
  int count() const { return static_cast<int>(means_[0].size()); }

 private:
  std::array<std::vector<float>, 3> means_;
};

// Fits a line per channel to the means of the areas; areas that do not agree with the others in all channels get no
// weight.
class LightFit {
 public:
  explicit LightFit(int areas = 0);

  struct Result {
    ColourLight light;
    double correlation;  // -1 to 1, of the means of the weighted areas in both images, mean over the channels
  };
  // Uses the areas with use[area] != 0. `start`: an illumination under which these agree, or null if none is known;
  // more than half of them must then share one. Empty if too few areas have a mean, or if the result is not a plausible
  // change of illumination.
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
