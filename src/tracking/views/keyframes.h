// Keyframes: pictures of the region of interest (ROI) that were tracked well, so that the search for a lost ROI knows
// it at scales and tilts that the reference does not show. They give places to start from and nothing else: what is
// aligned and believed is always the reference itself, which no keyframe replaces.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/lens.h"
#include "tracking/views/point_features.h"

namespace laparoscope_servo::tracking {

struct Keyframe {
  cv::Mat crop;       // of the image as it came: the ROI with a margin
  cv::Point first;    // px, of the crop's first pixel in that image
  Eigen::Matrix3d g;  // pixels of the reference to pixels of that image, determinant 1
  cv::Mat1b trusted;  // 255 for the ROI's pixels (of the reference) that were neither occluded nor saturated, else 0

  bool described = false;  // features are drawn when a search first needs them: a tracked image only pays for the copy
  DescribedPoints features;
};

// How differently two homographies show the ROI's centre: 1 for a factor of 1.3 in length in some direction, or a turn
// of 0.6 rad in the image; the larger of both. Infinite where a homography shows it mirrored or not at all.
double keyframeDistance(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b, const geometry::Rectangle& roi);

class Keyframes {
 public:
  // capacity: how many are kept beside the reference, 0 or more. With a lens the images are raw, homographies and
  // the ROI rectified.
  explicit Keyframes(int capacity, std::shared_ptr<const image::Lens> lens = nullptr)
      : capacity_(capacity), lens_(std::move(lens)) {}

  // Forgets every keyframe; the reference becomes the first. `weights` is CV_32F of the ROI's size, 0 where it cannot
  // be trusted.
  void setReference(const cv::Mat& image, const geometry::Rectangle& roi, const cv::Mat1f& weights);

  // Whether a keyframe at `g` would be at a distance of at least 1 from each that is stored and, when all places are
  // taken, further from them than the least singular of those is from the others. Keyframes spread in this way, and
  // after some time none is replaced any more.
  bool wants(const Eigen::Matrix3d& g) const;

  // Stores a keyframe that wants() said yes to.
  void add(const cv::Mat& image, const Eigen::Matrix3d& g, const cv::Mat1f& weights);

  // Stores the picture, or one that replaces it soon, as the most recent keyframe, beside those: tissue that bleeds, or
  // is cut, looks as it did last. Does not allocate once it has stored one. Nothing where capacity is 0.
  void addRecent(const cv::Mat& image, const Eigen::Matrix3d& g, const cv::Mat1f& weights);

  // With the reference, which is at 0, and the most recent one, which is the last; 0 before the reference is set.
  int count() const { return static_cast<int>(keyframes_.size()) + (hasRecent() ? 1 : 0); }
  bool hasRecent() const { return !recent_.crop.empty(); }
  Keyframe& at(int k) { return k < stored() ? keyframes_[k] : recent_; }
  const Keyframe& at(int k) const { return k < stored() ? keyframes_[k] : recent_; }
  const geometry::Rectangle& roi() const { return roi_; }

 private:
  int stored() const { return static_cast<int>(keyframes_.size()); }
  cv::Rect boxOf(const cv::Mat& image, const Eigen::Matrix3d& g) const;
  double nearest(const Eigen::Matrix3d& g, int except) const;
  int leastSingular() const;
  Keyframe cut(const cv::Mat& image, const Eigen::Matrix3d& g, const cv::Mat1f& weights) const;

  int capacity_;
  std::shared_ptr<const image::Lens> lens_;
  geometry::Rectangle roi_;
  std::vector<Keyframe> keyframes_;
  Keyframe recent_;
  cv::Mat recent_pixels_;  // its crop's memory, enough for any
};

}  // namespace laparoscope_servo::tracking
