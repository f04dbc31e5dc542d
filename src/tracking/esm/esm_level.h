// One level of ESM's reference, and what an alignment works with there.
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

// Of one channel.
struct EsmPlane {
  image::Patch value;
  image::Patch warped;  // the image at the last iteration
  // Of the light, per block, row by row [grey levels]. With Light::kLocal each block's bias is kept for intensities
  // about the block's own mean in the reference: it then stays when the gain changes, from level to level and from
  // image to image.
  std::vector<double> mean;
  std::vector<double> bias;    // from the last alignment
  std::vector<double> before;  // from the one before

  // What gain * image lacks in a block.
  double biasOf(std::size_t block, double gain) const { return bias[block] + (1.0 - gain) * mean[block]; }
};

struct EsmLevel {
  // Of the pyramid's level `l`; `roi` in whole pixels. No planes when the ROI's smaller side has fewer than 8 px there.
  // With a lens (null: none) the pyramid is of a raw image, and the ROI in rectified pixels.
  EsmLevel(const image::RegionPyramid& reference, const geometry::Rectangle& roi, int l,
           const image::Lens* lens = nullptr);

  // Fills in the blocks' means, which are 0 without.
  void centreLight();

  // Weights where the image was valid at the last iteration.
  const image::Patch& usedWeight() const { return all_valid ? weight : used; }
  // After a warp that was not valid everywhere: a pixel beside one that is not valid has no gradient.
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
  std::vector<int> light_row_begin;  // rows; the last is the height
  int light_columns = 0;
  std::vector<int> coarser_light_block;  // of the next coarser level, where a block's centre lies
  std::uint64_t aligned = 0;             // number of the last alignment, among those of all levels
};

// Once both levels have their blocks: fills in the finer one's coarser_light_block.
void matchLightBlocks(const EsmLevel& coarse, EsmLevel& fine);

// The light of the finer level's blocks changes by as much as that of the coarser ones did in the last alignment there.
void inheritLight(const EsmLevel& coarse, EsmLevel& fine);

// Weights of a level from those of the next finer one: the least that a pixel covers.
void coarsenWeights(const EsmLevel& fine, std::vector<float>& scratch, EsmLevel& coarse);

}  // namespace laparoscope_servo::tracking
