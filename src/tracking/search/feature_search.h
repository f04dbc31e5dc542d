// Finds a lost region of interest (ROI) by points (ORB) matched between the image and the stored views of it.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <vector>

#include "laparoscope_servo/image/pyramid.h"
#include "laparoscope_servo/tracking/tracker_config.h"
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

  // Where the views say that the ROI may be in `image` (CV_8UC1 or CV_8UC3), best first; none when nothing agrees. The
  // reference is asked every time, the other views one a call in turn, so that the time is bounded whatever is stored.
  // Draws the features of a view when it is its turn for the first time.
  std::vector<FeatureCandidate> find(const cv::Mat& image, const image::ChannelWeights& weights, Keyframes& keyframes);

  // Starts the turns again.
  void restart() { turn_ = 0; }

 private:
  Features draw(const cv::Mat& image, const cv::Point& first, const cv::Mat1b& mask, double scale,
                const image::ChannelWeights& weights, int count, bool spread);
  void describe(Keyframe& view, const geometry::Rectangle& roi, double scale, const image::ChannelWeights& weights);
  void match(const Keyframe& view, const geometry::Rectangle& roi, const Features& seen, double scale,
             std::vector<FeatureCandidate>& found) const;

  bool plausible(const Eigen::Matrix3d& g, const geometry::Rectangle& roi) const;

  SearchConfig config_;
  int saturation_;         // grey levels
  double max_area_ratio_;  // of the ROI, to the reference
  std::shared_ptr<const image::Lens> lens_;
  cv::Ptr<cv::ORB> many_;  // of the image, thinned out afterwards
  cv::Ptr<cv::ORB> few_;   // of a view
  int turn_ = 0;
};

}  // namespace laparoscope_servo::tracking
