#include "tracking/occlusion/structure_gate.h"

#include <algorithm>
#include <limits>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::tracking {

namespace {

// Adds a row of pixels to the sums of the columns, which are six arrays one after the other.
LAPAROSCOPE_SERVO_CLONES
void addRow(const float* __restrict image, const float* __restrict reference, const float* __restrict weight, int count,
            float* __restrict sums) {
  float* __restrict w = sums;
  float* __restrict a = sums + count;
  float* __restrict b = sums + 2 * count;
  float* __restrict aa = sums + 3 * count;
  float* __restrict bb = sums + 4 * count;
  float* __restrict ab = sums + 5 * count;
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float wa = weight[i] * image[i];
    const float wb = weight[i] * reference[i];
    w[i] += weight[i];
    a[i] += wa;
    b[i] += wb;
    aa[i] += wa * image[i];
    bb[i] += wb * reference[i];
    ab[i] += wa * reference[i];
  }
}

}  // namespace

void StructureStatistics::compute(const PatchPair* channels, int count, const image::Patch& weight,
                                  const image::AreaGrid& grid) {
  areas_.assign(grid.count(), {});
  for (int c = 0; c < count; ++c) add(channels[c], 1.0 / count, weight, grid);
}

void StructureStatistics::add(const PatchPair& channel, double part, const image::Patch& weight,
                              const image::AreaGrid& grid) {
  const image::Patch& image = *channel.image;
  const image::Patch& reference = *channel.reference;
  const int width = grid.width();
  columns_.resize(static_cast<std::size_t>(6) * width);
  for (int row = 0; row < grid.rows(); ++row) {
    std::fill(columns_.begin(), columns_.end(), 0.0f);
    for (int j = grid.rowBegin(row); j < grid.rowBegin(row + 1); ++j) {
      addRow(image.row(j), reference.row(j), weight.row(j), width, columns_.data());
    }
    for (int column = 0; column < grid.columns(); ++column) {
      double sums[6] = {};
      for (int k = 0; k < 6; ++k) {
        const float* values = columns_.data() + static_cast<std::size_t>(k) * width;
        for (int i = grid.columnBegin(column); i < grid.columnBegin(column + 1); ++i) sums[k] += values[i];
      }
      const int area = row * grid.columns() + column;
      const double n = sums[0];
      if (!(n > 0.0)) continue;
      const double a = sums[1] / n;
      const double b = sums[2] / n;
      AreaMoments& moments = areas_[area];
      moments.share = static_cast<float>(n / grid.pixelsIn(area));
      moments.image += static_cast<float>(part * std::max(0.0, sums[3] / n - a * a));
      moments.reference += static_cast<float>(part * std::max(0.0, sums[4] / n - b * b));
      moments.both += static_cast<float>(part * (sums[5] / n - a * b));
    }
  }
}

float StructureStatistics::dissimilarity(int k, double gain, double sigma) const {
  const AreaMoments& m = areas_[k];
  if (!(m.share >= 0.5f)) return std::numeric_limits<float>::quiet_NaN();
  const double image = gain * gain * m.image;
  const double difference = image + m.reference - 2.0 * gain * m.both;
  return static_cast<float>(difference / (0.5 * (image + m.reference) + sigma * sigma));
}

}  // namespace laparoscope_servo::tracking
