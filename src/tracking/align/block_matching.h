// Block matching: measures how far blocks of the region of interest (ROI) are from where a homography puts them, by the
// correlation of local contrast.
//
// It is independent of ESM and of its assumptions: gain, haze and shading that vary smoothly do not change local
// contrast, weak texture counts as much as strong texture, and each block is searched for by itself. It is used to
// check an estimate, and to correct it where ESM was pulled away.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/image/pyramid.h"

namespace laparoscope_servo::tracking {

struct BlockShift {
  Eigen::Vector2d centre;  // px of the reference
  Eigen::Vector2d shift;   // px of the reference: the tissue at the reference's `centre` is seen at g (centre + shift)
  double correlation = 0.0;  // -1 to 1, at the place where it is seen
  bool confident = false;    // a clear peak, and at least two other blocks moved alike
};

class BlockMatching {
 public:
  static constexpr int kAlong = 6;  // blocks along each side of the ROI
  static constexpr int kMostBlocks = kAlong * kAlong;
  static constexpr int kSide = 24;  // side of a block, px of the level on which blocks are searched

  // With a lens pyramids are of raw images; everything else is in rectified pixels.
  explicit BlockMatching(std::shared_ptr<const image::Lens> lens = nullptr) : lens_(std::move(lens)) {}

  // Searches on the finest level that tells something: one on which the ROI is not too large and enough blocks have
  // unique texture. On smooth tissue that is a coarser level, where a block holds more of it.
  // The pyramid must hold the ROI with kReach px of the search level around it.
  void setReference(const image::RegionPyramid& reference, const geometry::Rectangle& roi);
  // Searches on this level of the pyramid, or on its coarsest one. Each level doubles the search range.
  void setReference(const image::RegionPyramid& reference, const geometry::Rectangle& roi, int level);

  // Drops the blocks for which `used(centre)` is false; `centre` in px of the reference.
  template <typename Used>
  void keep(const Used& used) {
    const auto unused = [&](const cv::Point& block) { return !used(centreOf(block)); };
    blocks_.erase(std::remove_if(blocks_.begin(), blocks_.end(), unused), blocks_.end());
  }

  // Level of the pyramid on which blocks are searched.
  int level() const { return level_; }
  // Number of blocks whose texture is unique within the search range.
  int blocks() const { return static_cast<int>(blocks_.size()); }
  // The ROI has room for all kMostBlocks, at different places: if few of them are unique, it is not for its size.
  bool hasRoom() const { return has_room_; }
  // px of the reference per px of the level on which blocks are searched.
  double scale() const { return scale_; }
  // Side of a block [px of the reference].
  double side() const { return kSide * scale_; }

  // Measures the shifts of all blocks that lie in the image. The result is valid until the next call.
  const std::vector<BlockShift>& measure(const image::RegionPyramid& current, const Eigen::Matrix3d& g);

 private:
  static constexpr int kReach = 8;  // search range: px of the level in each direction
  struct Peak {
    double x, y, top, second;
  };

  // Returns whether all of it lies in the image.
  bool look(const image::RegionPyramid& current, const Eigen::Matrix3d& g);
  void contrast();
  Peak find(const cv::Point& block);
  Eigen::Vector2d centreOf(const cv::Point& block) const;

  std::shared_ptr<const image::Lens> lens_;
  int level_ = 0;
  double scale_ = 1.0;  // px of the reference per px of the level
  Eigen::Matrix3d reference_T_crop_ = Eigen::Matrix3d::Identity();
  cv::Mat1f warped_, valid_, detail_, reference_;
  bool has_room_ = false;
  std::vector<float> column_sums_;
  std::vector<cv::Point> blocks_;  // first pixel of each block in the crop
  std::vector<BlockShift> shifts_;
};

}  // namespace laparoscope_servo::tracking
