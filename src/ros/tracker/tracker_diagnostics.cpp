#include "ros/tracker/tracker_diagnostics.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <sstream>

namespace laparoscope_servo {

namespace {

using diagnostic_msgs::DiagnosticStatus;
using tracking::State;

int levelOf(State state) {
  switch (state) {
    case State::kSearching:
      return DiagnosticStatus::WARN;
    case State::kLost:
      return DiagnosticStatus::ERROR;
    default:
      return DiagnosticStatus::OK;
  }
}

std::string withReason(const tracking::TrackResult& result) {
  return tracking::stateName(result.state) + (result.reason.empty() ? "" : ": " + result.reason);
}

}  // namespace

void TrackerDiagnostics::processed(double now, const Processed& processed, bool ignores_distortion) {
  recall_ = processed.recall;
  const bool had_roi = result_.state != State::kIdle;
  result_ = processed.result;
  if (had_roi && result_.state == State::kIdle) last_reset_ = result_.reason;
  feed_.processed(now, processed.period, processed.processing_time, processed.repeats.whole > 0);
  if (processed.motion_wanted) {
    ++window_.motion_wanted;
    if (processed.motion_error.empty()) ++window_.motion_given;
    if (processed.result.motion_used) ++window_.motion_used;
    if (!processed.motion_error.empty()) motion_error_ = processed.motion_error;
  }
  ++window_.images;
  if (!processed.external_mask.mask.empty()) {
    ++window_.mask_given;
    if (processed.external_mask.age > 0.0) ++window_.mask_predicted;
    mask_age_ = processed.external_mask.age;
    mask_grown_ = processed.external_mask.grown;
    mask_share_ = processed.mask_share;
  }
  selection_failed_ = !processed.selection_error.empty();
  has_camera_ = processed.camera.has_value();
  camera_error_ = processed.camera_error;
  has_colour_ = processed.image.channels() == 3;
  ignores_distortion_ = ignores_distortion;
  rectifies_ = processed.lens != nullptr;
}

void TrackerDiagnostics::maskRefused(double now, const std::string& why) {
  mask_refusal_ = why;
  mask_refused_at_ = now;
}

void TrackerDiagnostics::recallRefused(const std::string& why) {
  const std::lock_guard<std::mutex> lock(recall_mutex_);
  recall_refusal_ = why;
}

std::string TrackerDiagnostics::recall() const {
  const std::lock_guard<std::mutex> lock(recall_mutex_);
  return recall_ + (recall_refusal_.empty() ? "" : "; last request refused: " + recall_refusal_);
}

void TrackerDiagnostics::summarise(double now, diagnostic_updater::DiagnosticStatusWrapper& status) const {
  if (!feed_.summariseMissing(now, withReason(result_), status)) {
    status.summary(static_cast<unsigned char>(levelOf(result_.state)), withReason(result_));
    if (recall_ != "none") status.message += "; " + recall_;
    if (selection_failed_) status.mergeSummary(DiagnosticStatus::ERROR, "no region selected");
    if (!has_camera_)
      status.mergeSummary(DiagnosticStatus::WARN, "no homography in normalised coordinates: " + camera_error_);
  }
  feed_.warnOfPublishers(status);
  constexpr double kMemory = 5.0;  // s
  if (now - mask_refused_at_ <= kMemory)
    status.mergeSummary(DiagnosticStatus::WARN, "external mask refused: " + mask_refusal_);
}

std::string TrackerDiagnostics::colourGate() const {
  if (config_.occlusion.colour == tracking::ColourGate::kNone) return "none";
  return has_colour_ ? "on" : "stands aside: the images have no colour";
}

std::string TrackerDiagnostics::robotMotion() const {
  if (!with_robot_motion_) return "not asked for";
  const std::string text = "given for " + std::to_string(window_.motion_given) + " of " +
                           std::to_string(window_.motion_wanted) + " images, used for " +
                           std::to_string(window_.motion_used);
  return window_.motion_given < window_.motion_wanted ? text + "; last missing: " + motion_error_ : text;
}

std::string TrackerDiagnostics::externalMask() const {
  if (!with_external_mask_) return "not asked for";
  std::ostringstream text;
  text.precision(3);
  text << "used for " << window_.mask_given << " of " << window_.images << " images, of these "
       << window_.mask_predicted << " as predicted";
  if (window_.mask_given > 0) {
    text << "; the last one was " << mask_age_ << " s old, grown by " << mask_grown_ << " px, and covers "
         << mask_share_ << " of the region";
  }
  return text.str();
}

void TrackerDiagnostics::fill(double now, diagnostic_updater::DiagnosticStatusWrapper& status) {
  summarise(now, status);
  status.add("state", tracking::stateName(result_.state));
  status.add("reason", result_.reason);
  status.add("last reset", last_reset_);
  feed_.fill(now, status);
  status.addf("visible fraction", "%.3f", result_.visible_fraction);
  status.addf("zncc", "%.3f", result_.zncc);
  status.addf("corner error [px]", "%.3f", result_.corner_error);
  status.addf("centre error [px]", "%.3f", result_.centre_error);
  status.add("ROI [px]", result_.state == State::kIdle ? "none" : roiText(result_.roi));
  status.add("intrinsics", has_camera_ ? "from camera_info" : camera_error_.empty() ? "unknown" : camera_error_);
  status.add("lens distortion", rectifies_            ? "corrected by the tracker"
                                : ignores_distortion_ ? "not corrected: camera_info has some; see parameter rectify"
                                                      : "none, or corrected");
  status.add("recall", recall());
  status.add("colour gate", colourGate());
  status.add("robot motion", robotMotion());
  status.add("external mask", externalMask());
  window_ = Window();
}

}  // namespace laparoscope_servo
