#include "ros/tracker/tracker_state_report.h"

#include "laparoscope_servo/tracking/track_result.h"
#include "ros/tracker/region_proposal.h"

namespace laparoscope_servo {

namespace {

constexpr double kSilence = 1.0;  // s without a usable image; every camera is faster
// s between two messages that differ in the reason only, since faster changes are not readable
constexpr double kReasonPause = 0.2;
constexpr double kRepeat = 1.0;  // s

}  // namespace

TrackerState notStarted(const std::string& why) {
  TrackerState message;
  message.state = TrackerState::NOT_STARTED;
  message.reason = why;
  return message;
}

std::optional<TrackerState> TrackerStateReport::processed(double now, const Processed& processed) {
  const tracking::TrackResult& result = processed.result;
  const TrackerState before = message_;
  last_image_ = now;
  refusal_.clear();
  // The tracker says for one image why the region is gone; that is the reason until another one is selected.
  const bool idle = result.state == tracking::State::kIdle;
  const bool stays_idle = idle && tracker_state_ == tracking::stateName(result.state);
  tracker_state_ = tracking::stateName(result.state);
  if (!stays_idle) tracker_reason_ = result.reason;
  message_.header = processed.header;
  message_.state = tracker_state_;
  message_.reason = tracker_reason_;
  message_.width = static_cast<std::uint32_t>(processed.image.cols);
  message_.height = static_cast<std::uint32_t>(processed.image.rows);
  message_.proposal = proposalMessage(processed.proposal);
  message_.view = processed.recall == "none" ? "" : processed.recall;
  message_.reference_stamp = ros::Time();
  message_.region.fill(0.0);
  if (!idle) {
    message_.reference_stamp = processed.reference_stamp;
    const geometry::Quadrilateral corners = result.roi.corners();
    for (int k = 0; k < 4; ++k) {
      message_.region[2 * k] = corners[k].x();
      message_.region[2 * k + 1] = corners[k].y();
    }
  }
  if (message_.state != before.state) message_.since = processed.header.stamp;
  const bool changed = message_.state != before.state || message_.width != before.width ||
                       message_.height != before.height || message_.view != before.view ||
                       message_.proposal != before.proposal || message_.reference_stamp != before.reference_stamp ||
                       message_.region != before.region;
  return say(now, changed);
}

std::optional<TrackerState> TrackerStateReport::tick(double now) {
  if (started_ < 0.0) started_ = now;
  const bool never = last_image_ < 0.0;
  if (now - (never ? started_ : last_image_) <= kSilence) return never ? std::nullopt : say(now, false);
  const bool changed = message_.state != TrackerState::NO_IMAGE;
  if (changed) message_.since = message_.header.stamp;
  message_.state = TrackerState::NO_IMAGE;
  if (!refusal_.empty() && now - refused_at_ <= kSilence) {
    message_.reason = "image refused: " + refusal_;
  } else if (!refusal_.empty()) {
    message_.reason = "no image for more than 1 s; before: images that were refused";
  } else if (never) {
    message_.reason = "no image has come yet";
  } else {
    message_.reason = "no image for more than 1 s; before: " + tracker_state_ +
                      (tracker_reason_.empty() ? "" : ": " + tracker_reason_);
  }
  return say(now, changed);
}

std::optional<TrackerState> TrackerStateReport::say(double now, bool at_once) {
  const double since = now - said_at_;
  const bool first = said_at_ < 0.0;
  const bool reworded = message_.reason != said_reason_ && since >= kReasonPause;
  if (!first && !at_once && !reworded && since < kRepeat) return std::nullopt;
  said_at_ = now;
  said_reason_ = message_.reason;
  return message_;
}

}  // namespace laparoscope_servo
