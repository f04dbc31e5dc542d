#include "tracking/occlusion/light_change.h"

#include <algorithm>
#include <limits>

#include "laparoscope_servo/robust/median.h"
#include "tracking/occlusion/colour_gate.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr float kWhite = 255.0f;
constexpr float kMaxGain = 2.0f;
constexpr float kLeastLevel = 16.0f;  // grey levels of a median; below it the ratio is noise
// The share of an area that has to clip before clipping can account for another colour: a distance (2) of 0.5, the
// paper's threshold, takes about as much of the area in other bins.
constexpr float kLeastClipped = 0.1f;

}  // namespace

LightChange::LightChange(int bins, const image::AreaGrid& grid)
    : bins_(bins), grid_(grid), histogram_(bins), relit_(bins) {
  int most = 0;
  for (int area = 0; area < grid.count(); ++area) most = std::max(most, grid.pixelsIn(area));
  for (std::vector<Pixel>* pixels : {&reference_, &current_})
    pixels->reserve(most);  // nothing is allocated while tracking
  channel_.reserve(most);
}

void LightChange::collect(const image::ColourPatch& patch, int area, std::vector<Pixel>& pixels) const {
  pixels.clear();
  const int row = area / grid_.columns(), column = area % grid_.columns();
  for (int j = grid_.rowBegin(row); j < grid_.rowBegin(row + 1); ++j) {
    for (int i = grid_.columnBegin(column); i < grid_.columnBegin(column + 1); ++i) {
      if (!patch.valid(j, i)) continue;
      pixels.push_back({static_cast<float>(patch.blue(j, i)), static_cast<float>(patch.green(j, i)),
                        static_cast<float>(patch.red(j, i))});
    }
  }
}

float LightChange::median(const std::vector<Pixel>& pixels, float Pixel::*channel) {
  channel_.clear();
  for (const Pixel& pixel : pixels) channel_.push_back(pixel.*channel);
  return robust::median(channel_);
}

void LightChange::fill(const std::vector<Pixel>& pixels, float gain, std::vector<float>& histogram) const {
  std::fill(histogram.begin(), histogram.end(), 0.0f);
  const float share = 1.0f / static_cast<float>(pixels.size());
  for (const Pixel& pixel : pixels) {
    const float feature = normalisedFeature(std::min(kWhite, gain * pixel.red), std::min(kWhite, gain * pixel.green),
                                            std::min(kWhite, gain * pixel.blue));
    histogram[normalisedBin(feature, bins_)] += share;  // eq. (1)
  }
}

float LightChange::distance(const image::ColourPatch& reference, const image::ColourPatch& current, int area) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  if (!reference.has_colour || !current.has_colour) return kNone;
  collect(reference, area, reference_);
  collect(current, area, current_);
  const int needed = (grid_.pixelsIn(area) + 1) / 2;
  if (static_cast<int>(std::min(reference_.size(), current_.size())) < needed) return kNone;

  float before = kWhite, now = kWhite;
  for (float Pixel::*channel : {&Pixel::blue, &Pixel::green, &Pixel::red}) {
    const float a = median(reference_, channel), b = median(current_, channel);
    if (std::max(a, b) >= std::max(before, now)) continue;
    before = a;
    now = b;
  }
  if (std::min(before, now) < kLeastLevel || std::max(before, now) > kMaxGain * std::min(before, now)) return kNone;
  const bool brighter = now >= before;
  const std::vector<Pixel>& bright = brighter ? current_ : reference_;
  const std::vector<Pixel>& dark = brighter ? reference_ : current_;
  const auto clips = [](const Pixel& pixel) { return std::max({pixel.blue, pixel.green, pixel.red}) >= kWhite; };
  if (static_cast<float>(std::count_if(bright.begin(), bright.end(), clips)) <
      kLeastClipped * static_cast<float>(bright.size())) {
    return kNone;
  }
  fill(bright, 1.0f, histogram_);
  fill(dark, brighter ? now / before : before / now, relit_);
  return bhattacharyyaDistance(histogram_.data(), relit_.data(), bins_);  // eq. (2)
}

}  // namespace laparoscope_servo::tracking
