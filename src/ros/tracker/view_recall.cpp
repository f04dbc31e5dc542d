#include "ros/tracker/view_recall.h"

#include <cmath>
#include <utility>

namespace laparoscope_servo {

namespace {

std::string called(const RecallStep& step) {
  return step.name.empty() ? "the region of the frozen picture" : "view '" + step.name + "'";
}

}  // namespace

bool hasArrived(const tracking::TrackResult& result, const tracking::ViewConfig& config) {
  if (result.state != tracking::State::kTracking) return false;
  const geometry::Quadrilateral corners = result.roi.corners();
  const double distance = (geometry::apply(result.g, result.roi.centre()) - result.roi.centre()).norm();
  const double scale =
      std::sqrt(geometry::signedArea(geometry::apply(result.g, corners)) / geometry::signedArea(corners));
  return distance <= config.arrival_centre && std::abs(scale - 1.0) <= config.arrival_scale;
}

void ViewRecall::begin(std::vector<RecallStep> steps) {
  steps_ = std::move(steps);
  at_ = 0;
  due_ = true;
  arrived_ = false;
  describe();
}

void ViewRecall::end(const std::string& why) {
  if (!active()) return;
  text_ = called(steps_.back()) + " given up: " + why;
  steps_.clear();
  due_ = arrived_ = false;
}

void ViewRecall::see(const tracking::TrackResult& result) {
  if (!active() || due_ || arrived_ || !hasArrived(result, config_)) return;
  if (at_ + 1 < steps_.size()) {
    ++at_;
    due_ = true;
  } else {
    arrived_ = true;
  }
  describe();
}

void ViewRecall::describe() {
  const std::string name = called(steps_.back());
  if (arrived_) {
    text_ = "arrived at " + name;
    return;
  }
  text_ = "going to " + name;
  if (at_ + 1 < steps_.size()) {
    text_ += ", now to '" + steps_[at_].name + "' (" + std::to_string(at_ + 1) + " of " +
             std::to_string(steps_.size()) + ")";
  }
}

}  // namespace laparoscope_servo
