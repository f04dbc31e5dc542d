// The dominant motion from each image to the next: what DominantMotion is made of.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "laparoscope_servo/features/image_sequence.h"
#include "laparoscope_servo/motion/dominant_motion.h"
#include "motion/motion_estimator.h"
#include "motion/region_anchor.h"
#include "motion/region_window.h"

namespace laparoscope_servo::motion {

class MotionSequence {
 public:
  explicit MotionSequence(const MotionConfig& config);

  // As those of DominantMotion.
  const MotionResult& begin(const cv::Mat& image, double stamp, const std::optional<geometry::Rectangle>& region,
                            const cv::Mat& mask);
  const MotionResult& track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion,
                            const cv::Mat& mask);
  void reset(features::Reason reason);

  const MotionResult& result() const { return result_; }
  const MotionSupport& support() const { return estimator_.support(); }
  cv::Point supportOrigin() const { return box_.tl(); }  // px, of the image
  const MotionImage& last() const { return last_; }      // the image of the last call; without a region
  // The last pair of images was, whatever has still to be confirmed; and the covariance of its motion.
  bool believed() const { return believed_; }
  const tracking::Matrix8d& covariance() const { return covariance_; }

 private:
  void start(const cv::Mat& image, double stamp, const std::optional<geometry::Rectangle>& region, const cv::Mat& mask,
             features::Reason reason);
  void take(const cv::Mat& image, const cv::Mat& mask);
  void keep(const cv::Mat& image, const cv::Mat& mask);
  Eigen::Matrix3d predicted(double interval) const;
  features::Reason estimate(const std::optional<Eigen::Matrix3d>& motion);
  void tell(const MotionEstimate& found);
  features::Reason compare(features::Reason why);

  MotionConfig config_;
  features::StateKeeper keeper_;
  MotionEstimator estimator_;
  RegionAnchor anchor_;  // where there is a window
  MotionImage last_, current_;
  features::ImageSequence sequence_;
  std::optional<RegionWindow> window_;  // none: all of the image
  cv::Rect box_;                        // of both images, that the estimator gets
  cv::Mat picture_, mask_;            // the last image, where there is a window: the next one takes another part of it
  geometry::Quadrilateral region_{};  // in the last image
  geometry::Vector8d velocity_ = geometry::Vector8d::Zero();  // by s, of the last image that was believed
  bool believed_ = false;
  tracking::Matrix8d covariance_ = tracking::Matrix8d::Zero();
  std::vector<Eigen::Matrix3d> starts_;
  Eigen::Matrix3d expected_ = Eigen::Matrix3d::Identity();  // the step to this image, before it was looked at
  MotionResult result_;
};

}  // namespace laparoscope_servo::motion
