// The parts of the tracker, and the order of what is done with an image.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "laparoscope_servo/image/field_mask.h"
#include "laparoscope_servo/tracking/region_tracker.h"
#include "tracking/align/region_aligners.h"
#include "tracking/region_history.h"
#include "tracking/search/confirmation.h"
#include "tracking/search/region_search.h"

namespace laparoscope_servo::tracking {

class RegionTracker::Implementation {
 public:
  explicit Implementation(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens = nullptr)
      : config_(config),
        lens_(lens),
        aligners_(config, lens),
        history_(config.velocity_damping),
        search_(config, lens),
        confirmation_(config.quality) {}

  void setLens(const std::optional<image::Lens>& lens);
  TrackResult select(const cv::Mat& image, double stamp, const geometry::Rectangle& roi, const cv::Mat& mask);
  void recall(const cv::Mat& reference, double reference_stamp, const geometry::Rectangle& roi, double now);
  const TrackResult& track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion,
                           const cv::Mat& mask);
  void reset();
  cv::Mat occlusionMask() const;
  bool hasRoi() const { return state_ != State::kIdle; }
  const std::shared_ptr<const image::Lens>& lens() const { return lens_; }
  const TrackerConfig& config() const { return config_; }
  void retune(const TrackerConfig& config);

 private:
  double setReference(const cv::Mat& image, double stamp, const geometry::Rectangle& wanted,
                      const cv::Mat& mask = cv::Mat());
  std::optional<Eigen::Matrix3d> carriedBy(const std::optional<Eigen::Matrix3d>& motion) const;
  // Why the image does not continue the sequence; empty if it does.
  std::string whyAnotherSequence(const cv::Mat& image, double stamp) const;
  Attempt follow(const cv::Mat& image, double stamp, MotionPrior& prior);
  Attempt attempt(const cv::Mat& image, double stamp, const EsmState& start, const MotionPrior* prior,
                  const SearchPlace* searched = nullptr);
  Attempt search(const cv::Mat& image, double stamp);
  void decide(const Attempt& best, const MotionPrior& prior, double stamp);
  // Of the image, px of the raw one: where the ROI is seen at `g`, with room for what it may move besides.
  cv::Rect seenBox(const Eigen::Matrix3d& g) const;
  const Eigen::Matrix3d& shown() const;
  const TrackResult& report(const Attempt& attempt);
  const TrackResult& idle(double stamp, const std::string& reason);

  TrackerConfig config_;
  std::shared_ptr<const image::Lens> lens_;  // null: none
  std::string reset_reason_;                 // for the next image
  RegionAligners aligners_;
  RegionHistory history_;
  RegionSearch search_;
  Confirmation confirmation_;
  image::FieldMask field_;  // of the last image

  State state_ = State::kIdle;
  cv::Size image_size_;
  double reference_stamp_ = 0.0;
  double last_stamp_ = 0.0;
  std::optional<Eigen::Matrix3d> carried_;  // last G moved by the ego-motion: where the last attempt started from
  TrackResult result_;                      // of the last image
};

}  // namespace laparoscope_servo::tracking
