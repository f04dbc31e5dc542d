// The session's checks of images before and after tracking: jumps of time, changes of size, and pictures that repeat.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "ros/tracker/region_proposal.h"
#include "ros/tracker/tracker_session.h"

namespace laparoscope_servo {

namespace {

cv::Rect boxOf(const geometry::Quadrilateral& corners) {
  constexpr double kFar = 1e6;  // px: points further out are in no image, and may not fit an int
  Eigen::Vector2d low = corners[0];
  Eigen::Vector2d high = corners[0];
  for (const Eigen::Vector2d& corner : corners) {
    if (!(corner.array().abs() < kFar).all()) return {};  // also for NaN
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  return {cv::Point(static_cast<int>(low.x()), static_cast<int>(low.y())),
          cv::Point(static_cast<int>(high.x()), static_cast<int>(high.y()))};
}

// Angle of the region's upper edge.
double angleOf(const tracking::TrackResult& result) {
  const geometry::Quadrilateral corners = geometry::apply(result.g, result.roi.corners());
  const Eigen::Vector2d edge = corners[1] - corners[0];
  return std::atan2(edge.y(), edge.x());
}

}  // namespace

// The tracker's time always goes on; after a jump of the stamps, this function starts a new search for the region.
void TrackerSession::passGate(Processed& processed) {
  const cv::Size size = processed.image.size();
  const ImageGate::Passed passed = intake_.pass(processed.header.stamp, processed.image);
  processed.period = passed.period;
  if (passed.step_back > 0.0) {
    believed_stamp_.reset();
    repeats_.clear();  // a film that begins anew shows the same pictures
  }
  if (passed.loop) recall_.end("time jumped back");
  if (passed.loop && tracker_.hasRoi()) lookForReference("time jumped back");
  const bool size_returned = passed.other_size && !tracker_.hasRoi() && reference_ && reference_->image.size() == size;
  if (size_returned) lookForReference("the images have their old size again");
}

// During a recall its present view is the reference, and stays it.
void TrackerSession::lookForReference(const std::string& why) {
  if (!reference_ || reference_->stamp != reference_stamp_) return;
  try {
    tracker_.recall(reference_->image, reference_->stamp.toSec(), reference_->roi, intake_.time());
    believed_stamp_.reset();
  } catch (const std::invalid_argument& error) {
    tracker_.reset();
    recall_.end(why + ": " + error.what());
  }
}

// A region that is found again turned by more than 45 degrees may be correct, but no scope turns that fast: the picture
// was turned, or it comes from another camera. The state then stays SEARCHING for 3 s, longer than resume_time (2 s),
// so that motion does not resume by itself.
std::string TrackerSession::turnedTooFast(const tracking::TrackResult& result) const {
  constexpr double kMostTurn = M_PI / 4.0;  // rad
  constexpr double kHeldBack = 3.0;         // s
  if (!believed_stamp_ || result.selected_now || intake_.time() - believed_time_ > kHeldBack) return "";
  const double turn = std::remainder(angleOf(result) - believed_angle_, 2.0 * M_PI);
  if (std::abs(turn) <= kMostTurn) return "";
  std::ostringstream text;
  text.precision(2);
  text << "the picture turned by " << std::lround(turn * 180.0 / M_PI) << " degrees within "
       << intake_.time() - believed_time_ << " s";
  return text.str();
}

geometry::Quadrilateral TrackerSession::onSensor(geometry::Quadrilateral corners) const {
  for (Eigen::Vector2d& corner : corners) {
    if (lens_) corner = lens_->toRaw(corner).value_or(corner);
  }
  return corners;
}

// The first second is a region's trial. If the region is not TRACKING at its end, and not because it is covered, the
// reason proposes another one. The search goes on all the same: of 40 such regions on eight films 7 came back.
void TrackerSession::judgeSelection(const tracking::TrackResult& found, Processed& processed) {
  constexpr double kTrial = 1.0;  // s
  if (found.selected_now) trial_ends_ = intake_.time() + kTrial;
  if (found.selected_now || found.state == tracking::State::kTracking) trial_failed_ = false;
  if (!tracker_.hasRoi()) trial_ends_.reset();
  if (before_.state == tracking::State::kTracking && found.state != tracking::State::kTracking)
    lost_covered_ = !(found.visible_fraction >= parameters_.tracking.quality.min_visible_fraction);
  if (trial_ends_ && intake_.time() >= *trial_ends_) {
    trial_ends_.reset();
    trial_failed_ = found.state != tracking::State::kTracking && !lost_covered_ && reference_;
    if (trial_failed_) trial_proposal_ = regionThatWouldDo(tracker_, reference_->image, reference_->roi);
  }
  const bool lost = found.state == tracking::State::kSearching || found.state == tracking::State::kLost;
  if (!trial_failed_ || !lost) return;
  processed.result.reason += "; it was not held in its first second" + proposalText(trial_proposal_);
  processed.proposal = trial_proposal_;
}

// An estimate in a frozen feed is not reported as TRACKING, but the tracker does not lose the region for it.
void TrackerSession::watchPicture(Processed& processed) {
  using tracking::State;
  tracking::TrackResult& result = processed.result;
  tracking::FrozenFeed::Motion motion;
  motion.by_robot = robot_step_;
  std::optional<geometry::Quadrilateral> corners;
  if (result.selected_now) path_.clear();
  if (result.state == State::kTracking) {
    corners = geometry::apply(result.g, result.roi.corners());
    motion.step = path_.farthest(*corners, 1);
    box_ = boxOf(onSensor(*corners));
  }
  if (result.state == State::kIdle) box_ = {};
  processed.repeats = repeats_.see(processed.image, box_);
  if (corners) motion.of_part = path_.farthest(*corners, processed.repeats.part);
  path_.add(corners);
  feed_.see(processed.repeats, intake_.time(), motion);
  if (result.state == State::kTracking) {
    result.reason = turnedTooFast(result);
    if (!result.reason.empty()) result.state = State::kSearching;
  }
  if (feed_.reason().empty() && result.state == State::kTracking) {
    believed_time_ = intake_.time();
    believed_angle_ = angleOf(result);
  }
  if (feed_.reason().empty() || result.state == State::kIdle) return;
  if (result.state == State::kTracking) result.state = State::kSearching;
  result.reason = feed_.reason() + (result.reason.empty() ? "" : "; " + result.reason);
}

}  // namespace laparoscope_servo
