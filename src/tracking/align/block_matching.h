// Where pieces of the region of interest (ROI) really are, beside where a homography puts them: block matching on local
// contrast.
//
// It asks ESM for nothing and shares none of its assumptions: light that changes smoothly, gain, haze and shading leave
// local contrast as it is, a weak texture counts as much as a strong one, and no block knows of the others. So it tells
// whether an estimate is true, and where a homography cannot follow the tissue.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/image/pyramid.h"

namespace laparoscope_servo::tracking {

struct BlockShift {
  Eigen::Vector2d centre;  // px of the reference
  Eigen::Vector2d shift;   // px of the reference: what the reference shows at the centre is seen at g (centre + shift)
  double correlation = 0.0;  // -1 to 1, where it is seen
  bool confident = false;    // a clear peak, and other blocks moved alike
};

class BlockMatching {
 public:
  static constexpr int kAlong = 6;  // blocks along each side of the ROI
  static constexpr int kMostBlocks = kAlong * kAlong;
  static constexpr int kSide = 24;  // px of the level that blocks are searched on, of a block

  // With a lens pyramids are of raw images, all else is in rectified pixels. `coarser`: levels above the one that shows
  // the ROI's detail, to find blocks twice as far away for each.
  explicit BlockMatching(std::shared_ptr<const image::Lens> lens = nullptr, int coarser = 0)
      : lens_(std::move(lens)), coarser_(coarser) {}

  // The pyramid must hold the ROI with the margin (px) below where the image has it.
  void setReference(const image::RegionPyramid& reference, const geometry::Rectangle& roi);

  // How many blocks can be told from their surroundings at all.
  int blocks() const { return static_cast<int>(blocks_.size()); }
  // px of the reference per px of the level that blocks are searched on.
  double scale() const { return scale_; }
  // px of the reference, of the blocks' side.
  double side() const { return kSide * scale_; }

  // Of the blocks that the image shows. Valid until the next call.
  const std::vector<BlockShift>& measure(const image::RegionPyramid& current, const Eigen::Matrix3d& g);

 private:
  static constexpr int kReach = 8;  // px of the level, by which a block is searched for
  struct Peak {
    double x, y, top, second;
  };

  void look(const image::RegionPyramid& current, const Eigen::Matrix3d& g);
  void contrast();
  Peak find(const cv::Point& block);

  std::shared_ptr<const image::Lens> lens_;
  int coarser_ = 0;
  int level_ = 0;
  double scale_ = 1.0;  // px of the reference per px of the level
  Eigen::Matrix3d reference_T_crop_ = Eigen::Matrix3d::Identity();
  cv::Mat1f warped_, valid_, detail_, reference_;
  std::vector<float> column_sums_;
  std::vector<cv::Point> blocks_;  // their first pixels in the crop
  std::vector<BlockShift> shifts_;
};

}  // namespace laparoscope_servo::tracking
