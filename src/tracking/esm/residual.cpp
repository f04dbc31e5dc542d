#include "tracking/esm/residual.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "laparoscope_servo/robust/scale.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr double kMinSigma = 1.0;  // grey levels; below it quantisation errors would count as outliers
constexpr int kMaxSamples = 1024;  // samples of the residual, for its scale
constexpr int kRun = 4;            // px side by side, which share a cache line
// bins per grey level of the histogram of residuals, which ends at 128 grey levels
constexpr double kBinsPerLevel = 8.0;
constexpr int kBins = 1024;

// The robust scale: 1.4826 times the median of the `count` magnitudes in the histogram.
double scaleOf(const std::vector<int>& histogram, int count) {
  if (count == 0) return kMinSigma;
  // The median lies in the bin that reaches half of the samples, linearly interpolated within the bin.
  double below = 0.0;
  int bin = 0;
  while (below + histogram[bin] < 0.5 * count) below += histogram[bin++];
  const double median = (bin + (0.5 * count - below) / histogram[bin]) / kBinsPerLevel;
  return std::max(kMinSigma, robust::kMadToSigma * median);
}

}  // namespace

double matchMean(EsmLevel& level, double gain) {
  const image::Patch& weight = level.usedWeight();
  double common = 0.0;
  for (EsmPlane& plane : level.planes) {
    double sum = 0.0, weights = 0.0;
    for (int row = 0; row + 1 < static_cast<int>(level.light_row_begin.size()); ++row) {
      for (int j = level.light_row_begin[row]; j < level.light_row_begin[row + 1]; ++j) {
        for (int i = 0; i < level.width; ++i) {
          const double bias =
              plane.biasOf(row * level.light_columns + level.light_column_of_strip[i / image::Patch::kStrip], gain);
          sum += weight(j, i) * (plane.value(j, i) - gain * plane.warped(j, i) - bias);
          weights += weight(j, i);
        }
      }
    }
    const double missing = weights > 0.0 ? sum / weights : 0.0;
    for (double& bias : plane.bias) bias += missing;
    common += missing / static_cast<double>(level.planes.size());
  }
  return common;
}

double ResidualScale::of(const EsmLevel& level, double gain) {
  histogram_.assign(kBins, 0);
  const image::Patch& weight = level.usedWeight();
  const int pixels = level.width * level.height * static_cast<int>(level.planes.size());
  const int stride = kRun * std::max(1, pixels / kMaxSamples);
  const float g = static_cast<float>(gain);
  int count = 0;
  for (const EsmPlane& plane : level.planes) {
    std::size_t block_row = 0;
    for (int j = 0; j < level.height; ++j) {
      if (j >= level.light_row_begin[block_row + 1]) ++block_row;
      const float* weights = weight.row(j);
      const float* image = plane.warped.row(j);
      const float* reference = plane.value.row(j);
      // The runs start at another pixel in each row, so that they do not align with a pattern of the image.
      for (int first = (j * 7 * kRun) % stride / kRun * kRun; first < level.width; first += stride) {
        const std::size_t block =
            block_row * level.light_columns + level.light_column_of_strip[first / image::Patch::kStrip];
        const float b = static_cast<float>(plane.biasOf(block, gain));
        for (int i = first; i < std::min(first + kRun, level.width); ++i) {
          if (!(weights[i] > 0.0f)) continue;
          const float residual = std::abs(g * image[i] + b - reference[i]);
          ++histogram_[std::min(static_cast<int>(residual * static_cast<float>(kBinsPerLevel)), kBins - 1)];
          ++count;
        }
      }
    }
  }
  count_ = count;
  return scaleOf(histogram_, count);
}

double ResidualScale::ofKept(double sigma) const {
  const int bins = std::min(static_cast<int>(robust::kTukey * sigma * kBinsPerLevel), kBins);
  return scaleOf(histogram_, std::accumulate(histogram_.begin(), histogram_.begin() + bins, 0));
}

double ResidualScale::cost(double sigma) const {
  double sum = 0.0;
  for (int bin = 0; bin < kBins; ++bin) {
    if (histogram_[bin] == 0) continue;
    const double t = (bin + 0.5) / kBinsPerLevel / (robust::kTukey * sigma);
    const double left = std::max(0.0, 1.0 - t * t);
    sum += histogram_[bin] * (1.0 - left * left * left);  // the integral of Tukey's psi, scaled to end at 1
  }
  return count_ > 0 ? sum / count_ : 1.0;
}

}  // namespace laparoscope_servo::tracking
