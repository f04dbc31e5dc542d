#include "ros/tracker/tracker_diagnostics.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace laparoscope_servo {

namespace {

using diagnostic_msgs::DiagnosticStatus;
using tracking::State;

constexpr double kSilence = 2.0;  // s without an image, after which there is a warning

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
  ++images_;
  ++window_.images;
  window_.total_time += processed.processing_time;
  window_.longest_time = std::max(window_.longest_time, processed.processing_time);
  times_.add(now, processed.processing_time);
  countDropped(now, processed.period);
  if (processed.repeats.whole > 0) {
    ++repeated_;
    recent_repeated_.add(now, 1.0);
  }
  if (processed.motion_wanted) {
    ++window_.motion_wanted;
    if (processed.motion_error.empty()) ++window_.motion_given;
    if (processed.result.motion_used) ++window_.motion_used;
    if (!processed.motion_error.empty()) motion_error_ = processed.motion_error;
  }
  last_image_ = now;
  refusal_.clear();
  selection_failed_ = !processed.selection_error.empty();
  has_camera_ = processed.camera.has_value();
  camera_error_ = processed.camera_error;
  has_colour_ = processed.image.channels() == 3;
  ignores_distortion_ = ignores_distortion;
  rectifies_ = processed.lens != nullptr;
}

// A gap in the stamps, relative to the usual period, counts as dropped images: they were lost on the way, or given up
// for a newer one (ImageBacklog).
void TrackerDiagnostics::countDropped(double now, double period) {
  if (!(period > 0.0)) return;
  // A gap can be detected only with a period from several images.
  if (usual_period_ > 0.0 && period > 1.5 * usual_period_) {
    const double missing = std::round(period / usual_period_) - 1.0;
    dropped_ += static_cast<std::uint64_t>(missing);
    recent_dropped_.add(now, missing);
  }
  periods_.add(now, period);
  constexpr std::size_t kEnough = 10;
  if (periods_.count(now) >= kEnough) usual_period_ = periods_.percentile(now, 0.5);
}

void TrackerDiagnostics::answered(double now, double latency) {
  latencies_.add(now, latency);
}

void TrackerDiagnostics::refused(double now, const std::string& error, Refusal cause) {
  ++refused_[static_cast<std::size_t>(cause)];
  last_image_ = now;
  refusal_ = last_refusal_ = error;
}

std::string TrackerDiagnostics::refusals() const {
  static const char* const names[] = {"data", "stamp", "size", "sender"};
  std::string text;
  for (const Refusal cause : kRefusals) {
    const auto index = static_cast<std::size_t>(cause);
    text += (text.empty() ? "" : ", ") + std::string(names[index]) + " " + std::to_string(refused_[index]);
  }
  return text;
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
  if (!last_image_) {
    status.summary(DiagnosticStatus::WARN, "no image has come yet");
  } else if (now - *last_image_ > kSilence) {
    status.summary(DiagnosticStatus::WARN, "no image for more than 2 s; before: " + withReason(result_));
  } else if (!refusal_.empty()) {
    status.summary(DiagnosticStatus::ERROR, "image refused: " + refusal_);
  } else {
    status.summary(static_cast<unsigned char>(levelOf(result_.state)), withReason(result_));
    if (recall_ != "none") status.message += "; " + recall_;
    if (selection_failed_) status.mergeSummary(DiagnosticStatus::ERROR, "no region selected");
    if (!has_camera_)
      status.mergeSummary(DiagnosticStatus::WARN, "no homography in normalised coordinates: " + camera_error_);
  }
  const struct {
    const char* topic;
    unsigned number;
    const std::string& complaint;
  } topics[] = {{"image", publishers_.images, publishers_.image_complaint},
                {"camera_info", publishers_.camera_infos, publishers_.camera_info_complaint}};
  for (const auto& topic : topics) {
    if (topic.number < 2 && topic.complaint.empty()) continue;
    std::string text = std::to_string(topic.number) + " publishers of " + topic.topic;
    if (!topic.complaint.empty()) text += ": " + topic.complaint;
    status.mergeSummary(DiagnosticStatus::WARN, text);
  }
}

void TrackerDiagnostics::fillRecent(double now, diagnostic_updater::DiagnosticStatusWrapper& status) {
  const struct {
    const char* name;
    RecentValues& values;
  } all[] = {{"time per image", times_}, {"latency, stamp to result", latencies_}};
  for (const auto& each : all) {
    status.addf(std::string(each.name) + ", 95th percentile [ms]", "%.3f", 1e3 * each.values.percentile(now, 0.95));
    status.addf(std::string(each.name) + ", 99th percentile [ms]", "%.3f", 1e3 * each.values.percentile(now, 0.99));
  }
  status.add("images dropped", dropped_);
  status.addf("images dropped, last minute", "%.0f", recent_dropped_.sum(now));
  status.addf("usual period [ms]", "%.3f", 1e3 * usual_period_);
  status.add("pictures repeated", repeated_);
  status.addf("pictures repeated, last minute", "%.0f", recent_repeated_.sum(now));
  status.add("publishers of image", publishers_.images);
  status.add("publishers of camera_info", publishers_.camera_infos);
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

void TrackerDiagnostics::fill(double now, diagnostic_updater::DiagnosticStatusWrapper& status) {
  summarise(now, status);
  const double duration = now - window_.start;
  status.add("state", tracking::stateName(result_.state));
  status.add("reason", result_.reason);
  status.add("last reset", last_reset_);
  status.addf("rate [Hz]", "%.2f", duration > 0.0 ? window_.images / duration : 0.0);
  status.addf("time per image, mean [ms]", "%.3f",
              window_.images > 0 ? 1e3 * window_.total_time / window_.images : 0.0);
  status.addf("time per image, longest [ms]", "%.3f", 1e3 * window_.longest_time);
  status.add("images processed", images_);
  fillRecent(now, status);
  status.add("images refused", std::accumulate(refused_.begin(), refused_.end(), std::uint64_t{0}));
  status.add("images refused, by cause", refusals());
  status.add("last refusal", last_refusal_);
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
  window_ = Window();
  window_.start = now;
}

}  // namespace laparoscope_servo
