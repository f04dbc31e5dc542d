#include "laparoscope_servo/tracking/colour_gate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace laparoscope_servo::tracking {

namespace {

// Grey levels added to the intensity, so that the colour of dark pixels, which is noise, does not fill the histogram.
constexpr float kDark = 16.0f;

}  // namespace

float hueSaturationFeature(float r, float g, float b) {
  const float s0 = std::max({r, g, b}) - std::min({r, g, b});  // S0 of (4)
  const float d = (r - g) * (r - g) + (r - b) * (g - b);       // the root's argument in (5)
  // cos H of (5) is (2 R - G - B) / (2 sqrt(D)); D is 0 only for grey pixels, where S0 is 0 as well.
  return d > 0.0f ? s0 * 0.5f * (2.0f * r - g - b) / std::sqrt(d) : 0.0f;  // eq. (4), (5)
}

float normalisedFeature(float r, float g, float b) {
  return hueSaturationFeature(r, g, b) / ((r + g + b) / 3.0f + kDark);
}

float bhattacharyyaDistance(const float* a, const float* b, int bins) {
  float coefficient = 0.0f;
  for (int l = 0; l < bins; ++l) coefficient += std::sqrt(a[l] * b[l]);  // eq. (3)
  return std::sqrt(std::max(0.0f, 1.0f - coefficient));                  // eq. (2)
}

void ColourHistograms::compute(const cv::Mat& patch, const cv::Mat1b& valid, const image::AreaGrid& grid) {
  histograms_.assign(static_cast<std::size_t>(grid.count()) * bins_, 0.0f);
  pixels_.assign(grid.count(), 0);
  const bool normalised = mode_ == ColourGate::kNormalised;
  const float low = normalised ? -1.5f : -255.0f;
  const float high = normalised ? 3.0f : 255.0f;
  const float scale = static_cast<float>(bins_) / (high - low);
  for (int j = 0; j < grid.height(); ++j) {
    const unsigned char* p = patch.ptr<unsigned char>(j);
    const unsigned char* ok = valid.ptr<unsigned char>(j);
    for (int i = 0; i < grid.width(); ++i, p += 3) {
      if (ok[i] == 0) continue;
      const float feature = normalised ? normalisedFeature(p[2], p[1], p[0]) : hueSaturationFeature(p[2], p[1], p[0]);
      const int bin = std::clamp(static_cast<int>((feature - low) * scale), 0, bins_ - 1);
      const int area = grid.areaOf(i, j);
      histograms_[static_cast<std::size_t>(area) * bins_ + bin] += 1.0f;
      ++pixels_[area];
    }
  }
  for (int area = 0; area < grid.count(); ++area) {  // eq. (1)
    float* h = histograms_.data() + static_cast<std::size_t>(area) * bins_;
    const float total = static_cast<float>(std::max(1, pixels_[area]));
    for (int l = 0; l < bins_; ++l) h[l] /= total;
  }
}

void areaDistances(const ColourHistograms& reference, const ColourHistograms& current, const image::AreaGrid& grid, int bins,
                   std::vector<float>& distances) {
  distances.resize(grid.count());
  for (int area = 0; area < grid.count(); ++area) {
    const int needed = (grid.pixelsIn(area) + 1) / 2;
    const bool comparable = reference.pixels(area) >= needed && current.pixels(area) >= needed;
    distances[area] = comparable ? bhattacharyyaDistance(reference.histogram(area), current.histogram(area), bins)
                                 : std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace laparoscope_servo::tracking
