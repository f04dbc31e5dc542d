// Which blocks of a region's texture the image shows where an alignment by ESM has them: by correlation, block by
// block. What does not show the reference is covered, and is given no weight.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/image/area_grid.h"
#include "laparoscope_servo/image/patch.h"
#include "tracking/esm/esm_level.h"
#include "tracking/occlusion/structure_gate.h"

namespace laparoscope_servo::tracking {

class BlockGate {
 public:
  // `reference`: the level that will be looked at; `weights`: CV_32F of its size, 0 to 1, how much of a pixel is
  // texture; `noise`: grey levels, a block that deviates by less than twice as much in the reference has no texture.
  void setReference(const EsmLevel& reference, const cv::Mat1f& weights, double noise);

  // Compares the level's reference with its warped image at the last iteration. A block is covered that correlates by
  // less than `min_correlation`; beside a covered one, by less than the middle between that and 1. A block without
  // texture is covered where most of the blocks around it are. Returns how many blocks are newly covered.
  int look(const EsmLevel& level, double min_correlation);
  // Whether the last look() changed the weights.
  bool changed() const { return changed_; }
  // Nothing is covered.
  void forget();

  // The reference's weights, 0 where blocks are covered.
  const cv::Mat1f& weights() const { return weights_; }
  int textured() const { return textured_; }  // blocks with texture in the reference, in the image at the last look()
  int correlated() const { return correlated_; }  // of them, those that are not covered
  double share() const { return textured_ > 0 ? static_cast<double>(correlated_) / textured_ : 0.0; }

 private:
  enum Verdict : char { kSilent, kShown, kDoubtful, kCovered };  // kSilent: without texture

  void judge(const EsmLevel& level, double min_correlation);
  bool coveredAround(int block) const;

  image::AreaGrid grid_;
  StructureStatistics statistics_;
  double least_variance_ = 0.0;  // grey levels squared, of a block with texture
  image::Patch of_reference_, in_image_;
  cv::Mat1f weights_;
  std::vector<Verdict> verdicts_;
  std::vector<char> covered_;
  int textured_ = 0, correlated_ = 0;
  bool changed_ = false;
};

}  // namespace laparoscope_servo::tracking
