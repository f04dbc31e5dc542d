// One level of ESM's reference, with the buffers of an alignment on that level.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/image/patch.h"
#include "laparoscope_servo/image/pyramid.h"
#include "laparoscope_servo/tracking/tracker_config.h"

namespace laparoscope_servo::tracking {

// One channel of a level.
struct EsmPlane {
  image::Patch value;
  image::Patch warped;  // the image at the last iteration
  // Illumination of each block, row by row [grey levels]. With Light::kLocal a block's bias refers to intensities
  // relative to the block's mean in the reference, so that it does not depend on the gain and holds from level to level
  // and from image to image.
  std::vector<double> mean;
  std::vector<double> bias;    // from the last alignment
  std::vector<double> before;  // bias before the current alignment

  // Bias of the block at this gain: gain * image + biasOf() = reference.
  double biasOf(std::size_t block, double gain) const { return bias[block] + (1.0 - gain) * mean[block]; }
};

struct EsmLevel {
  // Takes level `l` of the pyramid; `roi` in whole pixels. Has no planes if the ROI's smaller side has fewer than 8 px
  // there. With a lens (null: none) the pyramid is of a raw image, and the ROI in rectified pixels.
  EsmLevel(const image::RegionPyramid& reference, const geometry::Rectangle& roi, int l,
           const image::Lens* lens = nullptr);

  // Takes level `l` of another pyramid of the same kind, at the same place. Not with a lens. Does not allocate.
  void take(const image::RegionPyramid& reference, int l);

  // Fills in the blocks' means, which are 0 otherwise.
  void centreLight();

  // Weights where the image was valid at the last iteration.
  const image::Patch& usedWeight() const { return all_valid ? weight : used; }
  // Call after a warp that was not valid everywhere. A pixel beside an invalid one has no gradient and gets no weight.
  void useValid();

  std::vector<EsmPlane> planes;
  Eigen::Matrix3d image_T_patch;  // pixel (i, j) of the level to pixels of the reference image
  cv::Point first;                // pixel of the ROI that the level's pixel (0, 0) lies on
  double scale = 1.0;             // pixels of the reference image per pixel of the level
  int width = 0;                  // px of the level
  int height = 0;

  image::Patch weight;    // set by Esm::setWeights
  image::Patch used;      // weight where the image is valid, at the last iteration
  image::Patch valid;     // 1 where the image is valid, at the last iteration; 0 elsewhere
  bool all_valid = true;  // valid is 1 everywhere, and `used` is not written

  int cells_per_strip = 1;  // see sumCells
  int cell_rows = 8;
  // Blocks of light: whole strips of columns, whole cells of rows.
  std::vector<int> light_column_of_strip;
  std::vector<int> light_row_begin;  // first row of each row of blocks; the last entry is the height
  int light_columns = 0;
  std::vector<int> coarser_light_block;  // the block of the next coarser level in which a block's centre lies
  std::uint64_t aligned = 0;             // number of the last alignment, among those of all levels
};

// Fills in the finer level's coarser_light_block, once both levels have their blocks.
void matchLightBlocks(const EsmLevel& coarse, EsmLevel& fine);

// Adds to the biases of the finer level's blocks the change of the coarser blocks' biases in the last alignment there.
void inheritLight(const EsmLevel& coarse, EsmLevel& fine);

// Weights of a level: each the least of those of the finer level that the pixel covers.
void coarsenWeights(const EsmLevel& fine, std::vector<float>& scratch, EsmLevel& coarse);

}  // namespace laparoscope_servo::tracking
