#include "laparoscope_servo/ros/tracker_session.h"

#include <chrono>
#include <stdexcept>

#include "laparoscope_servo/ros/image_conversion.h"

namespace laparoscope_servo::skin {

namespace {

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

TrackerSession::TrackerSession(const TrackerParameters& parameters)
    : parameters_(parameters), tracker_(parameters.tracking), intrinsics_(parameters.image_kind) {
  start_roi_pending_ = start_roi_in_force_ = parameters.roi.has_value();
}

Processed TrackerSession::process(const sensor_msgs::Image& message,
                                  const std::optional<geometry::Rectangle>& request) {
  const Stopwatch watch;
  Processed processed;
  processed.header = message.header;
  processed.image = trackerImage(message);
  complete(processed, request);
  processed.processing_time = watch.seconds();
  return processed;
}

Processed TrackerSession::process(const cv::Mat& decoded, const std_msgs::Header& header,
                                  const std::optional<geometry::Rectangle>& request) {
  const Stopwatch watch;
  Processed processed;
  processed.header = header;
  processed.image = trackerImage(decoded);
  complete(processed, request);
  processed.processing_time = watch.seconds();
  return processed;
}

void TrackerSession::complete(Processed& processed, const std::optional<geometry::Rectangle>& request) {
  const ros::Time stamp = processed.header.stamp;
  const bool jumped_back = last_stamp_ && stamp < *last_stamp_;
  if (jumped_back && start_roi_in_force_) start_roi_pending_ = true;
  processed.result = track(processed, request);
  if (processed.result.state == tracking::State::kTracking) believed_stamp_ = stamp;
  if (!tracker_.hasRoi()) believed_stamp_.reset();
  last_stamp_ = stamp;
  image_size_ = processed.image.size();
  if (processed.result.selected_now) reference_stamp_ = stamp;
  processed.reference_stamp = reference_stamp_;
  intrinsics_.update(processed.image.size(), processed.result.selected_now || !tracker_.hasRoi());
  processed.camera = intrinsics_.camera();
  processed.camera_error = intrinsics_.error();
  if (!lens_error_.empty()) {
    processed.camera.reset();
    processed.camera_error = lens_error_;
  }
  processed.lens = lens_;
}

// Pixels of the image that was believed last to those of this one, for a plane parallel to the image.
std::optional<Eigen::Matrix3d> TrackerSession::motionBefore(Processed& processed) const {
  const ros::Time& stamp = processed.header.stamp;
  if (!camera_motion_ || !believed_stamp_ || !tracker_.hasRoi() || !(stamp > *believed_stamp_)) return std::nullopt;
  processed.motion_wanted = true;
  // That of the image before: when the camera changes, so does all that was tracked.
  const std::optional<geometry::PinholeCamera>& camera = intrinsics_.camera();
  if (!camera) {
    processed.motion_error = "no intrinsics: " + intrinsics_.error();
    return std::nullopt;
  }
  auto motion = camera_motion_(processed.header.frame_id, *believed_stamp_, stamp, processed.motion_error);
  if (!motion) return std::nullopt;
  if (lens_) {  // the rectified camera is turned against the one that tf knows
    const Eigen::Isometry3d turn(lens_->parameters().rotation);
    motion = turn * *motion * turn.inverse();
  }
  try {
    return geometry::pixelsFromPlane(*motion, Eigen::Vector3d::UnitZ(), parameters_.robot_motion.depth, *camera);
  } catch (const std::invalid_argument& error) {
    processed.motion_error = error.what();
    return std::nullopt;
  }
}

void TrackerSession::updateLens(const cv::Size& size) {
  if (parameters_.image_kind != ImageKind::kToRectify) return;
  const std::shared_ptr<const image::Lens>& lens = lens_source_.lensFor(size);
  lens_error_ = lens ? "" : "images cannot be rectified: " + lens_source_.error();
  if (!lens || lens == lens_) return;
  tracker_.setLens(*lens);
  lens_ = lens;
}

tracking::TrackResult TrackerSession::track(Processed& processed, const std::optional<geometry::Rectangle>& request) {
  const double stamp = processed.header.stamp.toSec();
  const bool from_parameters = !request && start_roi_pending_;
  updateLens(processed.image.size());
  if (!lens_error_.empty()) {
    if (request || from_parameters) processed.selection_error = lens_error_;
  } else if (request || from_parameters) {
    try {
      const auto result = tracker_.select(processed.image, stamp, request ? *request : *parameters_.roi);
      start_roi_pending_ = false;
      if (request) start_roi_in_force_ = false;
      return result;
    } catch (const std::invalid_argument& error) {
      // The parameters' ROI stays pending: the first images of a camera may be black.
      processed.selection_error = error.what();
    }
  }
  const bool had_roi = tracker_.hasRoi();
  tracking::TrackResult result = tracker_.track(processed.image, stamp, motionBefore(processed));
  if (!lens_error_.empty() && !had_roi) result.reason = lens_error_;
  if (!processed.selection_error.empty() && result.state == tracking::State::kIdle) {
    result.reason = "the ROI could not be selected: " + processed.selection_error;
  }
  return result;
}

cv::Mat TrackerSession::occlusionMask() const {
  const cv::Mat mask = tracker_.occlusionMask();
  return mask.empty() ? cv::Mat(cv::Mat::zeros(image_size_, CV_8UC1)) : mask;
}

void TrackerSession::reset() {
  tracker_.reset();
  believed_stamp_.reset();
  start_roi_pending_ = start_roi_in_force_ = false;
}

}  // namespace laparoscope_servo::skin
