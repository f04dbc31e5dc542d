#include "tracking/occlusion/light_change.h"

#include <algorithm>
#include <limits>

#include "laparoscope_servo/robust/median.h"
#include "tracking/occlusion/colour_gate.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr float kWhite = 255.0f;
constexpr float kMaxGain = 2.5f;      // allows for a lamp twice as bright, and some shading
constexpr float kLeastLevel = 16.0f;  // grey levels of a median; below it the ratio is noise
// Share of an area that must clip before clipping can explain a difference in colour: a distance (2) of 0.5, the
// paper's threshold, needs about that share of the area in other bins.
constexpr float kLeastClipped = 0.1f;
// Grey levels. Illuminations that differ by less, the noise of a pixel, count as equal.
constexpr float kSameLight = 2.0f;

}  // namespace

LightChange::LightChange(const image::ColourPatch& reference, int bins, const image::AreaGrid& grid)
    : bins_(bins),
      grid_(grid),
      reference_(reference.clone()),
      fit_(grid.count()),
      all_(grid.count(), 1),
      histogram_(bins),
      relit_(bins) {
  reference_colours_.compute(reference_, grid_);
  colours_ = reference_colours_;
  int most = 0;
  for (int area = 0; area < grid.count(); ++area) most = std::max(most, grid.pixelsIn(area));
  for (std::vector<Colour>* pixels : {&before_, &now_}) pixels->reserve(most);  // no allocation while tracking
  channel_.reserve(most);
  for (int area = 0; area < grid.count(); ++area) reference_clipped_.push_back(clippedShare(reference_, area));
}

std::optional<ColourLight> LightChange::propose(const std::vector<char>& use, const ColourLight* start,
                                                double least_correlation) {
  const std::optional<LightFit::Result> found = fit_.fit(colours_, reference_colours_, use, start);
  if (!found || !(found->correlation >= least_correlation)) return std::nullopt;
  if (largestDifference(found->light, known_) < kSameLight) return std::nullopt;
  return found->light;
}

float LightChange::clippedShare(const image::ColourPatch& patch, int area) const {
  int clipped = 0, valid = 0;
  const int row = area / grid_.columns(), column = area % grid_.columns();
  for (int j = grid_.rowBegin(row); j < grid_.rowBegin(row + 1); ++j) {
    const unsigned char* const b = patch.blue.ptr<unsigned char>(j);
    const unsigned char* const g = patch.green.ptr<unsigned char>(j);
    const unsigned char* const r = patch.red.ptr<unsigned char>(j);
    const unsigned char* const counts = patch.valid.ptr<unsigned char>(j);
    for (int i = grid_.columnBegin(column); i < grid_.columnBegin(column + 1); ++i) {
      valid += counts[i] & 1;
      clipped += counts[i] & 1 & static_cast<int>(std::max({b[i], g[i], r[i]}) == 255);
    }
  }
  return static_cast<float>(clipped) / std::max(1.0f, static_cast<float>(valid));
}

void LightChange::collect(const image::ColourPatch& patch, const ColourLight& light, int area,
                          std::vector<Colour>& pixels) const {
  pixels.clear();
  const int row = area / grid_.columns(), column = area % grid_.columns();
  for (int j = grid_.rowBegin(row); j < grid_.rowBegin(row + 1); ++j) {
    for (int i = grid_.columnBegin(column); i < grid_.columnBegin(column + 1); ++i) {
      if (!patch.valid(j, i)) continue;
      const std::array<unsigned char, 3> seen = {patch.blue(j, i), patch.green(j, i), patch.red(j, i)};
      Colour colour;
      for (int c = 0; c < 3; ++c) colour[c] = std::max(0.0f, light[c].gain * seen[c] + light[c].offset);
      pixels.push_back(colour);
    }
  }
}

float LightChange::median(const std::vector<Colour>& pixels, int channel) {
  channel_.clear();
  for (const Colour& pixel : pixels) channel_.push_back(pixel[channel]);
  return robust::median(channel_);
}

void LightChange::fill(const std::vector<Colour>& pixels, float gain, const Colour& ceiling,
                       std::vector<float>& histogram) const {
  std::fill(histogram.begin(), histogram.end(), 0.0f);
  const float share = 1.0f / static_cast<float>(pixels.size());
  for (const Colour& pixel : pixels) {
    Colour seen;
    for (int c = 0; c < 3; ++c) seen[c] = std::min(ceiling[c], gain * pixel[c]);
    histogram[normalisedBin(normalisedFeature(seen[2], seen[1], seen[0]), bins_)] += share;  // eq. (1)
  }
}

float LightChange::clippedDistance(const image::ColourPatch& current, const ColourLight& light, int area) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  if (std::max(reference_clipped_[area], clippedShare(current, area)) < kLeastClipped) return kNone;
  collect(reference_, ColourLight(), area, before_);
  collect(current, light, area, now_);
  const int needed = (grid_.pixelsIn(area) + 1) / 2;
  if (static_cast<int>(std::min(before_.size(), now_.size())) < needed) return kNone;

  float before = kWhite, now = kWhite;
  for (int c = 0; c < 3; ++c) {
    const float a = median(before_, c), b = median(now_, c);
    if (std::max(a, b) >= std::max(before, now)) continue;
    before = a;
    now = b;
  }
  if (std::min(before, now) < kLeastLevel || std::max(before, now) > kMaxGain * std::min(before, now)) return kNone;
  // Brightens the darker image to the level of the brighter one.
  const float gain_before = std::max(1.0f, now / before), gain_now = std::max(1.0f, before / now);
  Colour ceiling;
  for (int c = 0; c < 3; ++c) {
    ceiling[c] = std::min(gain_before * kWhite, gain_now * (light[c].gain * kWhite + light[c].offset));
  }
  fill(before_, gain_before, ceiling, histogram_);
  fill(now_, gain_now, ceiling, relit_);
  return bhattacharyyaDistance(histogram_.data(), relit_.data(), bins_);  // eq. (2)
}

}  // namespace laparoscope_servo::tracking
