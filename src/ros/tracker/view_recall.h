// The recall of a stored view, one reference after the other, and its text.
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/tracking/track_result.h"
#include "laparoscope_servo/tracking/view_config.h"
#include "laparoscope_servo/tracking/view_store.h"

namespace laparoscope_servo {

// One image, with all data of a view.
struct Snapshot {
  cv::Mat image;  // a copy
  ros::Time stamp;
  // px, the tracked region's place; empty: the snapshot cannot be stored
  std::optional<geometry::Rectangle> roi;
  std::string roi_error;                          // why
  std::optional<geometry::PinholeCamera> camera;  // if known
  std::shared_ptr<const image::Lens> lens;        // null: none
  std::string lens_error;                         // why no ROI can be selected because of the lens; else empty
  std::uint64_t epoch = 0;                        // see TrackerSession::recall
};

struct RecallStep {
  std::string name;  // name of the stored view; empty: the region drawn in a frozen picture
  tracking::View view;
  ros::Time stamp;
};

struct RecallRoute {
  std::vector<RecallStep> steps;  // the last one is the requested view
  std::uint64_t epoch = 0;        // epoch of the image from which it was planned
};

class ViewRecall {
 public:
  explicit ViewRecall(const tracking::ViewConfig& config) : config_(config) {}

  void begin(std::vector<RecallStep> steps);  // `steps`: at least one; replaces a present recall
  // Call if the reference has changed otherwise. Has no effect without a recall.
  void end(const std::string& why);

  // Whether a view of the recall is the reference, or will be with the next image.
  bool active() const { return !steps_.empty(); }
  // The view to make the reference before the next image; null for no change. Call taken() when this is done.
  const RecallStep* due() const { return due_ ? &steps_[at_] : nullptr; }
  bool first() const { return at_ == 0; }
  void taken() { due_ = false; }
  // Call after every image: proceeds to the next view when this one is reached.
  void see(const tracking::TrackResult& result);

  // Text with the requested view, the present view, whether it is reached, or why the recall was given up; "none"
  // before the first.
  const std::string& text() const { return text_; }

 private:
  void describe();

  tracking::ViewConfig config_;
  std::vector<RecallStep> steps_;
  std::size_t at_ = 0;
  bool due_ = false;
  bool arrived_ = false;
  std::string text_ = "none";
};

// The region's centre is within `arrival_centre` of its place in the reference, and its scale within `arrival_scale`.
bool hasArrived(const tracking::TrackResult& result, const tracking::ViewConfig& config);

}  // namespace laparoscope_servo
