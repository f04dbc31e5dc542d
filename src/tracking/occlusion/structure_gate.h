// Measures how well each area of the aligned region matches the reference's structure, whatever its colour, to find
// occluders such as tissue, smoke and blood. OcclusionGates compares the result with kMaxDissimilarity.
//
// Works after ESM on the warped patch, area by area, with each area's mean taken out: shading has no information on
// where the tissue is.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/image/area_grid.h"
#include "laparoscope_servo/image/patch.h"

namespace laparoscope_servo::tracking {

// Share of an area's pixels that are used, and their second moments about their means, per pixel [grey levels squared].
struct AreaMoments {
  float share = 0.0f;  // 0 to 1, of the area's pixels
  float image = 0.0f;
  float reference = 0.0f;
  float both = 0.0f;  // covariance
};

// The warped image and the reference, which are compared.
struct PatchPair {
  const image::Patch* image;
  const image::Patch* reference;
};

class StructureStatistics {
 public:
  // Computes the moments of all areas, means over the `count` channels of the patch. `weight`: 1 for pixels that are
  // used, 0 for the others. Sizes must agree with the grid's.
  void compute(const PatchPair* channels, int count, const image::Patch& weight, const image::AreaGrid& grid);

  const AreaMoments& area(int k) const { return areas_[k]; }
  int count() const { return static_cast<int>(areas_.size()); }

  // The variance of gain * image - reference over the mean variance of both plus that of the noise, whose standard
  // deviation per pixel of the difference is `sigma` [grey levels]. 0 for equal patches, about 2 for unrelated ones,
  // about 2/3 where there is nothing but noise. NaN where less than half of the area is used.
  float dissimilarity(int k, double gain, double sigma) const;

 private:
  void add(const PatchPair& channel, double part, const image::Patch& weight, const image::AreaGrid& grid);

  std::vector<AreaMoments> areas_;
  std::vector<float> columns_;  // six sums for each column of a row of areas
};

// Areas above this are occluded: for two patches of equal contrast 1 corresponds to a correlation of 0.5.
constexpr float kMaxDissimilarity = 1.0f;

}  // namespace laparoscope_servo::tracking
