#include "tracking/occlusion/light_change.h"

#include <algorithm>
#include <limits>

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

float relit(const ChannelLight& light, unsigned char value) {
  return std::max(0.0f, light.gain * static_cast<float>(value) + light.offset);
}

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
  for (int area = 0; area < grid.count(); ++area) {
    reference_clipped_.push_back(clippedShare(reference_, area));
    reference_medians_.push_back(medians(reference_, ColourLight(), area));
  }
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

// The light's gain is positive, so the median under it is that of the pixel values, relit.
LightChange::Medians LightChange::medians(const image::ColourPatch& patch, const ColourLight& light, int area) const {
  std::array<std::array<int, 256>, 3> counts = {};
  Medians result;
  const int row = area / grid_.columns(), column = area % grid_.columns();
  for (int j = grid_.rowBegin(row); j < grid_.rowBegin(row + 1); ++j) {
    const unsigned char* const b = patch.blue.ptr<unsigned char>(j);
    const unsigned char* const g = patch.green.ptr<unsigned char>(j);
    const unsigned char* const r = patch.red.ptr<unsigned char>(j);
    const unsigned char* const valid = patch.valid.ptr<unsigned char>(j);
    for (int i = grid_.columnBegin(column); i < grid_.columnBegin(column + 1); ++i) {
      const int counted = valid[i] & 1;
      counts[0][b[i]] += counted;
      counts[1][g[i]] += counted;
      counts[2][r[i]] += counted;
      result.pixels += counted;
    }
  }
  for (int c = 0; c < 3; ++c) {
    int value = 0;
    for (int below = counts[c][0]; value < 255 && below <= result.pixels / 2; below += counts[c][value]) ++value;
    result.colour[c] = relit(light[c], static_cast<unsigned char>(value));
  }
  return result;
}

void LightChange::fill(const image::ColourPatch& patch, const ColourLight& light, int area, float gain,
                       const Colour& ceiling, std::vector<float>& histogram) const {
  std::fill(histogram.begin(), histogram.end(), 0.0f);
  float pixels = 0.0f;
  const int row = area / grid_.columns(), column = area % grid_.columns();
  for (int j = grid_.rowBegin(row); j < grid_.rowBegin(row + 1); ++j) {
    for (int i = grid_.columnBegin(column); i < grid_.columnBegin(column + 1); ++i) {
      if (!patch.valid(j, i)) continue;
      Colour seen = {relit(light[0], patch.blue(j, i)), relit(light[1], patch.green(j, i)),
                     relit(light[2], patch.red(j, i))};
      for (int c = 0; c < 3; ++c) seen[c] = std::min(ceiling[c], gain * seen[c]);
      histogram[normalisedBin(normalisedFeature(seen[2], seen[1], seen[0]), bins_)] += 1.0f;
      pixels += 1.0f;
    }
  }
  for (float& share : histogram) share /= pixels;  // eq. (1)
}

float LightChange::clippedDistance(const image::ColourPatch& current, const ColourLight& light, int area) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  if (std::max(reference_clipped_[area], clippedShare(current, area)) < kLeastClipped) return kNone;
  const Medians& of_reference = reference_medians_[area];
  const Medians of_current = medians(current, light, area);
  const int needed = (grid_.pixelsIn(area) + 1) / 2;
  if (std::min(of_reference.pixels, of_current.pixels) < needed) return kNone;

  float before = kWhite, now = kWhite;
  for (int c = 0; c < 3; ++c) {
    const float a = of_reference.colour[c], b = of_current.colour[c];
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
  fill(reference_, ColourLight(), area, gain_before, ceiling, histogram_);
  fill(current, light, area, gain_now, ceiling, relit_);
  return bhattacharyyaDistance(histogram_.data(), relit_.data(), bins_);  // eq. (2)
}

}  // namespace laparoscope_servo::tracking
