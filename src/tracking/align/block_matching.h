// Block matching: measures how far blocks of the region of interest (ROI) are from where a homography puts them, by the
// correlation of local contrast.
//
// It is independent of ESM and of its assumptions: gain, haze and shading that vary smoothly do not change local
// contrast, weak texture counts as much as strong texture, and each block is searched for by itself. It is used to
// check an estimate, and to correct it where ESM was pulled away.
//
// Masks are CV_8UC1 of the image's size; empty: nothing is covered. What is not 0 there, and a pixel of the level
// beside it, is no part of a block: the border of a round picture is the strongest edge by far, and blocks that hold
// some of it are found at the border, which stands still while the tissue moves.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/colour_patch.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/image/pyramid.h"

namespace laparoscope_servo::tracking {

struct BlockShift {
  Eigen::Vector2d centre;  // px of the reference
  // px of the reference: the tissue at the reference's `centre` is seen at g (centre + shift)
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
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
  // The pyramid must hold the ROI with kReach px of the search level around it. `mask`: of the reference image.
  void setReference(const image::RegionPyramid& reference, const geometry::Rectangle& roi,
                    const cv::Mat& mask = cv::Mat());
  // Searches on this level of the pyramid, or on its coarsest one. Each level doubles the search range.
  void setReference(const image::RegionPyramid& reference, const geometry::Rectangle& roi, int level,
                    const cv::Mat& mask = cv::Mat());

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

  // Measures the shifts of all blocks that lie in the image; those that `mask`, of this image, covers are not
  // confident. The result is valid until the next call.
  const std::vector<BlockShift>& measure(const image::RegionPyramid& current, const Eigen::Matrix3d& g,
                                         const cv::Mat& mask = cv::Mat());

 private:
  static constexpr int kReach = 8;  // search range: px of the level in each direction
  struct Peak {
    double x, y, top, second;
  };

  // Samples the image and its local contrast. Returns whether all of the crop lies in the image.
  bool look(const image::RegionPyramid& current, const Eigen::Matrix3d& g, const cv::Mat& mask);
  void leaveOut(const cv::Mat& mask, const Eigen::Matrix3d& g);
  void contrast();
  static bool isValid(const cv::Point& block, const cv::Mat1f& valid);
  Peak find(const cv::Point& block);
  Eigen::Vector2d centreOf(const cv::Point& block) const;

  std::shared_ptr<const image::Lens> lens_;
  int level_ = 0;
  double scale_ = 1.0;  // px of the reference per px of the level
  Eigen::Matrix3d reference_T_crop_ = Eigen::Matrix3d::Identity();
  cv::Mat1f warped_, detail_, reference_;
  cv::Mat1f valid_;             // 1 where the image has the pixel and the mask does not cover it, else 0
  cv::Mat1f in_image_;          // with a mask: valid_ without it
  image::ColourPatch covered_;  // the mask, as the crop is sampled
  bool has_room_ = false;
  std::vector<float> column_sums_;
  std::vector<cv::Point> blocks_;  // first pixel of each block in the crop
  std::vector<BlockShift> shifts_;
};

}  // namespace laparoscope_servo::tracking
