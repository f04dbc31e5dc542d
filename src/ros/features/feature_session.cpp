#include "ros/features/feature_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/validation/error_report.h"
#include "ros/features/selection_text.h"

namespace laparoscope_servo {

namespace {

using features::State;
using Clock = std::chrono::steady_clock;

// Around all features that were seen; empty if none was.
cv::Rect boxOf(const features::TrackedFeatures& tracked) {
  constexpr double kFar = 1e6;  // px: points further out are in no image, and may not fit an int
  cv::Rect box;
  for (const features::TrackedFeature& feature : tracked.features) {
    if (feature.state != State::kTracking) continue;
    for (const Eigen::Vector2d& point : feature.outline) {
      if (!(point.array().abs() < kFar).all()) continue;  // also NaN
      const cv::Rect pixel(static_cast<int>(std::floor(point.x())), static_cast<int>(std::floor(point.y())), 1, 1);
      box = box.empty() ? pixel : box | pixel;
    }
  }
  return box;
}

// That nothing is seen any more where it would be.
void lower(features::TrackedFeatures& tracked, const std::string& reason) {
  for (features::TrackedFeature& feature : tracked.features) {
    if (feature.state == State::kTracking) {
      feature.state = State::kSearching;
      feature.expected_error = std::numeric_limits<double>::infinity();
      features::setUnknown(feature.covariance, feature.parameters.size());
    }
    feature.reason = reason + (feature.reason.empty() ? "" : "; " + feature.reason);
  }
  features::summarise(tracked, tracked.reason);
}

}  // namespace

FeatureSession::FeatureSession(const FeatureInput& input, std::unique_ptr<features::FeatureTracker> tracker)
    : tracker_(std::move(tracker)),
      intake_(input.image, input.input),
      intrinsics_(input.rectified_images ? ImageKind::kRectified : ImageKind::kRaw),
      depth_(input.robot_motion.depth),
      feed_(input.input) {
  validation::throwErrors("input", validate(input));
  if (input.selection.empty()) return;
  if (!tracker_->takesSelection())
    throw std::invalid_argument("selection = " + input.selection + ", expected none: nothing is to be selected");
  from_file_ = readSelection(input.selection);
  file_pending_ = true;
}

ProcessedFeatures FeatureSession::process(const sensor_msgs::Image& message,
                                          const std::optional<features::FeatureSelection>& request) {
  const Clock::time_point begin = Clock::now();
  ProcessedFeatures processed;
  processed.header = message.header;
  processed.image = intake_.decode(message);
  complete(processed, request);
  processed.processing_time = std::chrono::duration<double>(Clock::now() - begin).count();
  return processed;
}

ProcessedFeatures FeatureSession::process(const cv::Mat& decoded, const std_msgs::Header& header,
                                          const std::optional<features::FeatureSelection>& request) {
  const Clock::time_point begin = Clock::now();
  ProcessedFeatures processed;
  processed.header = header;
  processed.image = intake_.decode(decoded);
  complete(processed, request);
  processed.processing_time = std::chrono::duration<double>(Clock::now() - begin).count();
  return processed;
}

ProcessedFeatures FeatureSession::notSeen(const std_msgs::Header& header, const std::string& why) const {
  ProcessedFeatures not_seen;
  not_seen.header = header;
  not_seen.result = tracker_->features();
  not_seen.selection_stamp = selection_stamp_;
  lower(not_seen.result, why);
  return not_seen;
}

void FeatureSession::complete(ProcessedFeatures& processed, const std::optional<features::FeatureSelection>& request) {
  const ImageGate::Passed passed = intake_.pass(processed.header.stamp, processed.image);
  processed.period = passed.period;
  if (passed.step_back > 0.0) repeats_.clear();  // a film that begins anew shows the same pictures
  if (passed.loop) {
    selection_stamp_ = ros::Time();
    time_began_again_ = tracker_->features().state != State::kIdle;
    tracker_->reset();
    file_pending_ = file_pending_ || file_selected_;
    last_stamp_.reset();
  }
  const bool idle = tracker_->features().state == State::kIdle;
  intrinsics_.update(processed.image.size(), idle || request || file_pending_);
  processed.camera_error = intrinsics_.error();
  track(processed, request);
  watchPicture(processed);
  // A motion that tf does not know yet is a part of the next one, unless the features were seen without it.
  const auto& told = processed.result.features;
  const bool is_any_seen = std::any_of(
      told.begin(), told.end(), [](const features::TrackedFeature& each) { return each.state == State::kTracking; });
  if (processed.repeats.whole == 0 && (processed.motion_error.empty() || is_any_seen))
    last_stamp_ = processed.header.stamp;
}

void FeatureSession::expectMotion(ProcessedFeatures& processed, features::FeaturePrior& prior) const {
  const ros::Time& stamp = processed.header.stamp;
  if (!camera_motion_ || !last_stamp_ || !(stamp > *last_stamp_)) return;
  prior.camera_motion = camera_motion_(processed.header.frame_id, *last_stamp_, stamp, processed.motion_error);
  if (!prior.camera_motion) return;
  if (!prior.camera) {
    processed.motion_error = "no intrinsics: " + intrinsics_.error();
    return;
  }
  try {
    prior.motion = geometry::pixelsFromPlane(*prior.camera_motion, Eigen::Vector3d::UnitZ(), depth_, *prior.camera);
  } catch (const std::invalid_argument& error) {
    processed.motion_error = error.what();
  }
}

void FeatureSession::track(ProcessedFeatures& processed, const std::optional<features::FeatureSelection>& request) {
  const double time = intake_.time();
  features::FeaturePrior prior;
  prior.camera = intrinsics_.camera();
  if (request || file_pending_) {
    try {
      processed.result = tracker_->select(processed.image, time, request ? *request : *from_file_, prior);
      file_selected_ = !request;
      file_pending_ = time_began_again_ = false;
      processed.selected_now = true;
      selection_stamp_ = processed.selection_stamp = processed.header.stamp;
      return;
    } catch (const std::invalid_argument& error) {
      // The file's selection stays pending: the first images of a camera may be black.
      processed.selection_error = error.what();
    }
  }
  expectMotion(processed, prior);
  processed.result = tracker_->track(processed.image, time, prior);
  processed.selection_stamp = selection_stamp_;
  if (processed.result.state != State::kIdle) time_began_again_ = false;
  if (time_began_again_) processed.result.reason = "time jumped back";
}

// A result in a frozen feed is not reported as TRACKING, but the tracker does not lose its features for it.
void FeatureSession::watchPicture(ProcessedFeatures& processed) {
  processed.repeats = repeats_.see(processed.image, boxOf(processed.result));
  feed_.see(processed.repeats, intake_.time(), {});
  if (!feed_.reason().empty()) lower(processed.result, feed_.reason());
}

void FeatureSession::reset() {
  tracker_->reset();
  selection_stamp_ = ros::Time();
  file_pending_ = file_selected_ = time_began_again_ = false;
}

}  // namespace laparoscope_servo
