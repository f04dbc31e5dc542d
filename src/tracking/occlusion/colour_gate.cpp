#include "tracking/occlusion/colour_gate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::tracking {

namespace {

// Grey levels added to the intensity, so that dark pixels, whose colour is noise, do not spread over the histogram.
constexpr float kDark = 16.0f;

// Range of the normalised feature.
constexpr float kNormalisedLow = -1.5f;
constexpr float kNormalisedHigh = 3.0f;

// Eq. (4) and (5); inline, for the loop over pixels below.
inline float feature(float r, float g, float b) {
  const float s0 = std::max(r, std::max(g, b)) - std::min(r, std::min(g, b));  // S0 of (4)
  const float d = (r - g) * (r - g) + (r - b) * (g - b);                       // the root's argument in (5)
  // cos H of (5) is (2 R - G - B) / (2 sqrt(D)). D is 0 only for grey pixels, where S0 is 0 as well; else it is 1 or
  // more.
  return s0 * 0.5f * (2.0f * r - g - b) / std::sqrt(d > 0.0f ? d : 1.0f);  // eq. (4), (5)
}

inline float intensity(float r, float g, float b) {
  return (r + g + b) / 3.0f + kDark;
}

inline float relit(const ChannelLight& light, float value) {
  const float lit = light.gain * value + light.offset;
  return lit < 0.0f ? 0.0f : (lit > 255.0f ? 255.0f : lit);
}

LAPAROSCOPE_SERVO_CLONES
void binsOfRow(const unsigned char* __restrict b, const unsigned char* __restrict g, const unsigned char* __restrict r,
               int count, const ColourLight& light, bool normalised, float low, float scale, int last,
               int* __restrict bin) {
  const float by_intensity = normalised ? 1.0f : 0.0f;
  const ChannelLight of_b = light[0], of_g = light[1], of_r = light[2];
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float red = relit(of_r, r[i]);
    const float green = relit(of_g, g[i]);
    const float blue = relit(of_b, b[i]);
    const float divisor = by_intensity * intensity(red, green, blue) + (1.0f - by_intensity);
    const int k = static_cast<int>((feature(red, green, blue) / divisor - low) * scale);
    bin[i] = k < 0 ? 0 : (k > last ? last : k);
  }
}

}  // namespace

float hueSaturationFeature(float r, float g, float b) {
  return feature(r, g, b);
}

float normalisedFeature(float r, float g, float b) {
  return feature(r, g, b) / intensity(r, g, b);
}

int normalisedBin(float feature, int bins) {
  const float scale = static_cast<float>(bins) / (kNormalisedHigh - kNormalisedLow);
  return std::clamp(static_cast<int>((feature - kNormalisedLow) * scale), 0, bins - 1);
}

float bhattacharyyaDistance(const float* a, const float* b, int bins) {
  float coefficient = 0.0f;
  for (int l = 0; l < bins; ++l) coefficient += std::sqrt(a[l] * b[l]);  // eq. (3)
  return std::sqrt(std::max(0.0f, 1.0f - coefficient));                  // eq. (2)
}

void ColourHistograms::compute(const image::ColourPatch& patch, const image::AreaGrid& grid, const ColourLight& light) {
  counts_.assign(static_cast<std::size_t>(grid.count()) * bins_, 0);
  histograms_.resize(counts_.size());
  pixels_.assign(grid.count(), 0);
  bin_of_.resize(grid.width());
  const bool normalised = mode_ == ColourGate::kNormalised;
  const float low = normalised ? kNormalisedLow : -255.0f;
  const float high = normalised ? kNormalisedHigh : 255.0f;
  const float scale = static_cast<float>(bins_) / (high - low);
  for (int j = 0; j < grid.height(); ++j) {
    binsOfRow(patch.blue.ptr<unsigned char>(j), patch.green.ptr<unsigned char>(j), patch.red.ptr<unsigned char>(j),
              grid.width(), light, normalised, low, scale, bins_ - 1, bin_of_.data());
    const unsigned char* valid = patch.valid.ptr<unsigned char>(j);
    for (int column = 0; column < grid.columns(); ++column) {
      const int area = grid.rowOf(j) * grid.columns() + column;
      int* counts = counts_.data() + static_cast<std::size_t>(area) * bins_;
      for (int i = grid.columnBegin(column); i < grid.columnBegin(column + 1); ++i) counts[bin_of_[i]] += valid[i] & 1;
    }
  }
  for (int area = 0; area < grid.count(); ++area) {  // eq. (1)
    const std::size_t first = static_cast<std::size_t>(area) * bins_;
    for (int l = 0; l < bins_; ++l) pixels_[area] += counts_[first + l];
    const float share = 1.0f / static_cast<float>(std::max(1, pixels_[area]));
    for (int l = 0; l < bins_; ++l) histograms_[first + l] = share * static_cast<float>(counts_[first + l]);
  }
}

void areaDistances(const ColourHistograms& reference, const ColourHistograms& current, const image::AreaGrid& grid,
                   int bins, std::vector<float>& distances) {
  distances.resize(grid.count());
  for (int area = 0; area < grid.count(); ++area) {
    const int needed = (grid.pixelsIn(area) + 1) / 2;
    const bool comparable = reference.pixels(area) >= needed && current.pixels(area) >= needed;
    distances[area] = comparable ? bhattacharyyaDistance(reference.histogram(area), current.histogram(area), bins)
                                 : std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace laparoscope_servo::tracking
