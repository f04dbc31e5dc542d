// Keeps the picture in which a region is drawn, and checks regions before one is selected. Not thread-safe.
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

  // Keeps the snapshot in place of the last one. `now`: s of a steady clock.
  void keep(const std::shared_ptr<const Snapshot>& snapshot, double now);
  // A small picture of the kept snapshot.
  cv::Mat preview();
  bool holds(const ros::Time& stamp) const { return kept_ && kept_->stamp == stamp; }
  // The kept snapshot. Throws std::invalid_argument if there is none, or one with another stamp, or if it is older than
  // views/max_frozen_age.
  std::shared_ptr<const Snapshot> kept(const ros::Time& stamp, double now) const;

  // Throws std::invalid_argument with the reason if a region would be refused in the snapshot's image.
  void check(const Snapshot& snapshot, const geometry::Rectangle& roi) const;
  // A region near it that would be accepted; empty if there is none.
  std::optional<geometry::Rectangle> propose(const Snapshot& snapshot, const geometry::Rectangle& roi) const;
  // The way from the image `now` to a region of the image `before`. Throws as check(), and if size or lens of the
  // images have changed since.
  RecallRoute route(const Snapshot& before, const geometry::Rectangle& roi, const Snapshot& now) const;

 private:
  tracking::RegionTracker trackerFor(const Snapshot& snapshot) const;

  TrackerParameters parameters_;
  std::shared_ptr<const Snapshot> kept_;
  double kept_at_ = 0.0;  // s
  Preview preview_;
};

}  // namespace laparoscope_servo
