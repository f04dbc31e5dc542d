#include "ros/tracker/feed_statistics.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace laparoscope_servo {

namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kSilence = 2.0;  // s without an image, after which there is a warning

}  // namespace

void FeedStatistics::processed(double now, double period, double processing_time, bool repeats) {
  ++images_;
  ++window_.images;
  window_.total_time += processing_time;
  window_.longest_time = std::max(window_.longest_time, processing_time);
  times_.add(now, processing_time);
  countDropped(now, period);
  if (repeats) {
    ++repeated_;
    recent_repeated_.add(now, 1.0);
  }
  last_image_ = now;
  refusal_.clear();
}

// A gap in the stamps, relative to the usual period, counts as dropped images: they were lost on the way, or given up
// for a newer one (ImageBacklog).
void FeedStatistics::countDropped(double now, double period) {
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

void FeedStatistics::answered(double now, double latency) {
  latencies_.add(now, latency);
}

void FeedStatistics::refused(double now, const std::string& error, Refusal cause) {
  ++refused_[static_cast<std::size_t>(cause)];
  last_image_ = now;
  refusal_ = last_refusal_ = error;
}

std::string FeedStatistics::refusals() const {
  static const char* const names[] = {"data", "stamp", "size", "sender"};
  std::string text;
  for (const Refusal cause : kRefusals) {
    const auto index = static_cast<std::size_t>(cause);
    text += (text.empty() ? "" : ", ") + std::string(names[index]) + " " + std::to_string(refused_[index]);
  }
  return text;
}

bool FeedStatistics::summariseMissing(double now, const std::string& before,
                                      diagnostic_updater::DiagnosticStatusWrapper& status) const {
  if (!last_image_) {
    status.summary(DiagnosticStatus::WARN, "no image has come yet");
  } else if (now - *last_image_ > kSilence) {
    status.summary(DiagnosticStatus::WARN, "no image for more than 2 s; before: " + before);
  } else if (!refusal_.empty()) {
    status.summary(DiagnosticStatus::ERROR, "image refused: " + refusal_);
  } else {
    return false;
  }
  return true;
}

void FeedStatistics::warnOfPublishers(diagnostic_updater::DiagnosticStatusWrapper& status) const {
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

void FeedStatistics::fillRecent(double now, diagnostic_updater::DiagnosticStatusWrapper& status) {
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

void FeedStatistics::fill(double now, diagnostic_updater::DiagnosticStatusWrapper& status) {
  const double duration = now - window_.start;
  status.addf("rate [Hz]", "%.2f", duration > 0.0 ? window_.images / duration : 0.0);
  status.addf("time per image, mean [ms]", "%.3f",
              window_.images > 0 ? 1e3 * window_.total_time / window_.images : 0.0);
  status.addf("time per image, longest [ms]", "%.3f", 1e3 * window_.longest_time);
  status.add("images processed", images_);
  fillRecent(now, status);
  status.add("images refused", std::accumulate(refused_.begin(), refused_.end(), std::uint64_t{0}));
  status.add("images refused, by cause", refusals());
  status.add("last refusal", last_refusal_);
  window_ = Window();
  window_.start = now;
}

}  // namespace laparoscope_servo
