// Finds a lost region of interest (ROI) by points matched between an image and the keyframes of it. One pass over an
// image is cut into pieces of known cost, so that it can go on while the next images come.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/image/pyramid.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "tracking/search/coarse_image.h"
#include "tracking/views/keyframes.h"

namespace laparoscope_servo::tracking {

struct FeatureCandidate {
  Eigen::Matrix3d g;  // reference to current pixels, determinant 1
  int inliers = 0;    // matches that agree with it
};

class FeatureSearch {
 public:
  // With a lens the images are raw, homographies and the ROI rectified.
  // Of the configuration `search`, what `esm` calls saturated, and which sizes `quality` will accept.
  explicit FeatureSearch(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens = nullptr);

  // A pass over an image begins. It asks the reference, the most recent keyframe, and one other in turn, so that the
  // time is bounded whatever is stored. `weights`: of the channel that the image shows.
  void begin(const CoarseImage& image, const image::ChannelWeights& weights, const Keyframes& keyframes);
  // There is something left to do in this pass.
  bool busy() const { return strip_ < strips_ || !asked_.empty(); }
  // What the next piece costs, s: see nominal_cost.
  double nextCost(const Keyframes& keyframes) const;
  // Does the next piece: draws the points of a strip of the image, or of a keyframe when it is asked for the first
  // time, or compares both.
  void work(Keyframes& keyframes);
  // Where the keyframes said, in this pass, that the ROI was in the image, best first; none when nothing agreed.
  std::vector<FeatureCandidate> found() const;

  // A whole pass over `image` (CV_8UC1 or CV_8UC3).
  std::vector<FeatureCandidate> find(const cv::Mat& image, const image::ChannelWeights& weights, Keyframes& keyframes);

  // See RegionTracker::retune.
  void retune(const TrackerConfig& config);

  // Starts the turns again, and leaves the pass.
  void restart();

 private:
  cv::Rect strip(int k) const;
  void drawStrip();
  void describe(Keyframe& keyframe, const geometry::Rectangle& roi);
  void match(const Keyframe& keyframe, const geometry::Rectangle& roi);
  void fit(const std::vector<cv::Point2f>& from, const std::vector<cv::Point2f>& to, const Eigen::Matrix3d& keyframe_g,
           const geometry::Rectangle& roi);
  bool plausible(const Eigen::Matrix3d& g, const geometry::Rectangle& roi) const;

  SearchConfig config_;
  int saturation_;         // grey levels
  double max_area_ratio_;  // of the ROI, to the reference
  std::shared_ptr<const image::Lens> lens_;
  int turn_ = 0;

  // The pass.
  CoarseImage coarse_;
  image::ChannelWeights weights_ = image::kLuma;
  int strip_ = 0, strips_ = 0;
  std::vector<int> asked_;  // keyframes, the next one last
  DescribedPoints seen_;
  std::vector<FeatureCandidate> found_;
};

}  // namespace laparoscope_servo::tracking
