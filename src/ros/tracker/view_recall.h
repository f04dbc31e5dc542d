// The way to a stored view, one reference after the other, and what is said of it.
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
#include "laparoscope_servo/tracking/region_tracker.h"
#include "laparoscope_servo/tracking/view_config.h"
#include "laparoscope_servo/tracking/view_store.h"

namespace laparoscope_servo {

// One image, with all that a view is made of.
struct Snapshot {
  cv::Mat image;  // a copy
  ros::Time stamp;
  std::optional<geometry::Rectangle> roi;         // px, the tracked region's place in it; empty: it cannot be stored
  std::string roi_error;                          // why
  std::optional<geometry::PinholeCamera> camera;  // as far as it is known
  std::shared_ptr<const image::Lens> lens;        // null: none
  std::string lens_error;                         // why nothing can be selected, as far as the lens is the reason
  std::uint64_t epoch = 0;                        // see TrackerSession::recall
};

struct RecallStep {
  std::string name;  // of the stored view; empty: it is the region that was drawn in a frozen picture
  tracking::View view;
  ros::Time stamp;
};

struct RecallRoute {
  std::vector<RecallStep> steps;  // the last one is the view that is asked for
  std::uint64_t epoch = 0;        // of the image that it was planned from
};

class ViewRecall {
 public:
  explicit ViewRecall(const tracking::ViewConfig& config) : config_(config) {}

  void begin(std::vector<RecallStep> steps);  // at least one; replaces a recall that is under way
  // Something else is the reference now. Says nothing where there was no recall.
  void end(const std::string& why);

  // A view of the recall is the reference, or about to become it.
  bool active() const { return !steps_.empty(); }
  // The view to take for the reference before the next image; null when it is to stay. taken() says that this was done.
  const RecallStep* due() const { return due_ ? &steps_[at_] : nullptr; }
  bool first() const { return at_ == 0; }
  void taken() { due_ = false; }
  // After every image: goes on to the next view when this one has been reached.
  void see(const tracking::TrackResult& result);

  // Which view it goes to, by which one, whether it is there, or why it was given up; "none" before the first.
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
