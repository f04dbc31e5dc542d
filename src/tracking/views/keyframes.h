// Keyframes: images in which the region of interest (ROI) was tracked well, so that the search for a lost ROI knows it
// at scales and tilts that the reference does not show. They only suggest places to start from; the template that is
// aligned is always the reference, which no keyframe replaces.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/features/described_points.h"
#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/lens.h"

namespace laparoscope_servo::tracking {

struct Keyframe {
  cv::Mat crop;       // part of the raw image: the ROI with a margin
  cv::Point first;    // px, of the crop's first pixel in that image
  Eigen::Matrix3d g;  // pixels of the reference to pixels of that image, determinant 1
  // Mask of the ROI in the reference: 255 where it was neither occluded nor saturated, else 0. Its pixels are those of
  // the weights that were given.
  cv::Mat1b trusted;

  // true: the features are computed. A search computes them when it first needs them, so that tracking only pays for
  // the copy
  bool described = false;
  int strips_described = 0;  // of a crop whose features are computed strip by strip
  features::DescribedPoints features;
};

// Difference of two homographies at the ROI's centre: 1 for a factor of 1.3 in length in some direction, or a turn of
// 0.6 rad in the image; the larger of both. Infinite if a homography shows the ROI mirrored or not at all.
double keyframeDistance(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b, const geometry::Rectangle& roi);

class Keyframes {
 public:
  // capacity: number of keyframes kept beside the reference, 0 or more. With a lens the images are raw, homographies
  // and the ROI rectified.
  explicit Keyframes(int capacity, std::shared_ptr<const image::Lens> lens = nullptr)
      : capacity_(capacity), lens_(std::move(lens)) {}

  // Forgets every keyframe; the reference becomes the first. `weights` is CV_32F of the ROI's size or a fraction
  // of it, 0 where it cannot be trusted.
  void setReference(const cv::Mat& image, const geometry::Rectangle& roi, const cv::Mat1f& weights);

  // Whether a keyframe at `g` would be at a distance of at least 1 from each that is stored and, when all places are
  // taken, further from them than the least singular of those is from the others. Keyframes spread in this way, and
  // after some time none is replaced any more.
  bool wants(const Eigen::Matrix3d& g) const;

  // Stores a keyframe. Call only if wants() returned true.
  void add(const cv::Mat& image, const Eigen::Matrix3d& g, const cv::Mat1f& weights);

  // Stores the image as the most recent keyframe, which is kept apart from the others and replaced by the next call:
  // tissue that bleeds or is cut looks as it did last. Does not allocate after the first call. Does nothing if capacity
  // is 0.
  void addRecent(const cv::Mat& image, const Eigen::Matrix3d& g, const cv::Mat1f& weights);

  // Number of keyframes, including the reference (index 0) and the most recent one (the last); 0 before the reference
  // is set.
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
  cv::Mat recent_pixels_;  // memory of its crop, large enough for any crop
};

}  // namespace laparoscope_servo::tracking
