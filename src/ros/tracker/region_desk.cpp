#include "ros/tracker/region_desk.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "ros/tracker/region_proposal.h"

namespace laparoscope_servo {

namespace {

bool sameLens(const Snapshot& a, const Snapshot& b) {
  return a.lens && b.lens ? *a.lens == *b.lens : !a.lens && !b.lens;
}

}  // namespace

cv::Mat RegionDesk::preview() {
  return kept_ ? preview_.of(kept_->image, kept_->lens) : cv::Mat();
}

void RegionDesk::keep(const std::shared_ptr<const Snapshot>& snapshot, double now) {
  kept_ = snapshot;
  kept_at_ = now;
}

std::shared_ptr<const Snapshot> RegionDesk::kept(const ros::Time& stamp, double now) const {
  if (!kept_) throw std::invalid_argument("no picture is kept: call freeze_image first");
  if (!holds(stamp)) {
    throw std::invalid_argument("the picture that was frozen is kept no more: another one was frozen since");
  }
  const double age = now - kept_at_;
  if (!(age <= parameters_.views.max_frozen_age)) {
    std::ostringstream text;
    text << "the picture was frozen " << std::lround(age) << " s ago, expected at most "
         << parameters_.views.max_frozen_age << " s (parameter views/max_frozen_age)";
    throw std::invalid_argument(text.str());
  }
  return kept_;
}

void RegionDesk::check(const Snapshot& snapshot, const geometry::Rectangle& roi) const {
  if (!snapshot.lens_error.empty()) throw std::invalid_argument(snapshot.lens_error);
  trackerFor(snapshot).check(snapshot.image, roi);
}

std::optional<geometry::Rectangle> RegionDesk::propose(const Snapshot& snapshot, const geometry::Rectangle& roi) const {
  if (!snapshot.lens_error.empty()) return std::nullopt;
  return regionThatWouldDo(trackerFor(snapshot), snapshot.image, roi);
}

tracking::RegionTracker RegionDesk::trackerFor(const Snapshot& snapshot) const {
  tracking::RegionTracker tracker(parameters_.tracking);
  if (snapshot.lens) tracker.setLens(*snapshot.lens);
  return tracker;
}

RecallRoute RegionDesk::route(const Snapshot& before, const geometry::Rectangle& roi, const Snapshot& now) const {
  if (before.image.size() != now.image.size() || before.image.type() != now.image.type() || !sameLens(before, now)) {
    throw std::invalid_argument(
        "the images have another size, colour or lens than the picture in which the region was drawn");
  }
  check(before, roi);
  const geometry::Rectangle whole{std::floor(roi.x), std::floor(roi.y), std::floor(roi.width), std::floor(roi.height)};
  return {{{"", {before.image, whole}, before.stamp}}, now.epoch};
}

}  // namespace laparoscope_servo
