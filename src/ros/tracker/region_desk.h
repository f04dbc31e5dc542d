// Questions about regions before one is selected: would it be taken, and the picture that is kept to draw one in. Not
// thread-safe.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/tracking/region_tracker.h"
#include "ros/tracker/preview.h"
#include "ros/tracker/tracker_parameters.h"
#include "ros/tracker/view_recall.h"

namespace laparoscope_servo {

class RegionDesk {
 public:
  explicit RegionDesk(const TrackerParameters& parameters) : parameters_(parameters) {}

  // Keeps it, in place of the one before.
  void keep(const std::shared_ptr<const Snapshot>& snapshot) { kept_ = snapshot; }
  // Small, of the one that is kept.
  cv::Mat preview();
  // The snapshot that was kept. Throws std::invalid_argument when none was, or one of another stamp.
  const Snapshot& kept(const ros::Time& stamp) const;

  // Whether a region would be taken in the snapshot's image. Throws std::invalid_argument that says why not.
  void check(const Snapshot& snapshot, const geometry::Rectangle& roi) const;
  // One near it that would be, where it would not; empty where there is none.
  std::optional<geometry::Rectangle> propose(const Snapshot& snapshot, const geometry::Rectangle& roi) const;
  // The way to a region of the image that was kept, from what is seen `now`. Throws as the two above do, and when the
  // images have another size or another lens since.
  RecallRoute route(const ros::Time& stamp, const geometry::Rectangle& roi, const Snapshot& now) const;

 private:
  tracking::RegionTracker trackerFor(const Snapshot& snapshot) const;

  TrackerParameters parameters_;
  std::shared_ptr<const Snapshot> kept_;
  Preview preview_;
};

}  // namespace laparoscope_servo
