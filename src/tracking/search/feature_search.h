// Finds a lost region of interest (ROI) by points matched between an image and the keyframes. A pass over an image is
// split into pieces of known cost, so that it can continue while the next images come.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "laparoscope_servo/features/described_points.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/image/pyramid.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "tracking/search/coarse_image.h"
#include "tracking/views/keyframes.h"

namespace laparoscope_servo::tracking {

struct FeatureCandidate {
  Eigen::Matrix3d g;  // reference to current pixels, determinant 1
  int inliers = 0;    // matches that agree with `g`
};

class FeatureSearch {
 public:
  // With a lens the images are raw, homographies and the ROI rectified.
  // Of the configuration it uses `search`, esm/saturation and quality/max_area_ratio.
  explicit FeatureSearch(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens = nullptr);

  // Begins a pass over an image. It matches the reference, the most recent keyframe and, in turn, one of the others, so
  // that its time is bounded. `weights`: of the tracked channel, in which the coarse image was made.
  void begin(const CoarseImage& image, const image::ChannelWeights& weights, const Keyframes& keyframes);
  // Whether pieces of this pass are left.
  bool busy() const { return strip_ < strips_ || !asked_.empty(); }
  // Cost of the next piece [s], see nominal_cost.
  double nextCost(const Keyframes& keyframes) const;
  // Does the next piece: detects the points of a strip of the image; at a keyframe's first use makes its coarse image,
  // or detects the points of a strip of that; or matches both.
  void work(Keyframes& keyframes);
  // Places of the ROI by the keyframes matched in this pass, best first; empty if no matches agreed.
  std::vector<FeatureCandidate> found() const;

  // Does a whole pass over `image` (CV_8UC1 or CV_8UC3).
  std::vector<FeatureCandidate> find(const cv::Mat& image, const image::ChannelWeights& weights, Keyframes& keyframes);

  // See RegionTracker::retune.
  void retune(const TrackerConfig& config);

  // Ends the pass, and starts again with the first keyframe.
  void restart();

 private:
  int stripsOf(const cv::Size& size, double cost, double most_cost) const;
  int stripsOf(const Keyframe& keyframe) const;
  cv::Size coarseSize(const Keyframe& keyframe) const { return keyframe.crop.size() / coarse_.scale; }
  void drawStrip();
  void takeView(const Keyframe& keyframe, const geometry::Rectangle& roi);
  void describe(Keyframe& keyframe);
  void match(const Keyframe& keyframe, const geometry::Rectangle& roi);
  bool plausible(const Eigen::Matrix3d& g, const geometry::Rectangle& roi) const;

  SearchConfig config_;
  int saturation_;         // grey levels
  double max_area_ratio_;  // ratio of the ROI's areas in image and reference
  std::shared_ptr<const image::Lens> lens_;
  int turn_ = 0;

  // State of the pass.
  CoarseImage coarse_;
  image::ChannelWeights weights_ = image::kLuma;
  int strip_ = 0, strips_ = 0;
  std::vector<int> asked_;           // indices of the keyframes still to match, the next one last
  std::optional<CoarseImage> view_;  // of the keyframe that is being described; not usable where it was covered
  features::DescribedPoints seen_;
  std::vector<FeatureCandidate> found_;
};

}  // namespace laparoscope_servo::tracking
