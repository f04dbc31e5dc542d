#include "ros/tracker/tracker_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "laparoscope_servo/validation/error_report.h"
#include "ros/tracker/region_proposal.h"

namespace laparoscope_servo {

namespace {

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

TrackerSession::TrackerSession(const TrackerParameters& parameters)
    : parameters_(parameters),
      tracker_(parameters.tracking),
      recall_(parameters.views),
      intrinsics_(parameters.imageKind()),
      intake_(parameters.image, parameters.input),
      feed_(parameters.input) {
  validation::throwErrors("input", tracking::validate(parameters.input));
  start_roi_pending_ = parameters.roi.has_value();
}

Processed TrackerSession::process(const sensor_msgs::Image& message,
                                  const std::optional<geometry::Rectangle>& request) {
  const Stopwatch watch;
  Processed processed;
  processed.header = message.header;
  processed.image = intake_.decode(message);
  complete(processed, request);
  processed.processing_time = watch.seconds();
  return processed;
}

Processed TrackerSession::process(const cv::Mat& decoded, const std_msgs::Header& header,
                                  const std::optional<geometry::Rectangle>& request) {
  const Stopwatch watch;
  Processed processed;
  processed.header = header;
  processed.image = intake_.decode(decoded);
  complete(processed, request);
  processed.processing_time = watch.seconds();
  return processed;
}

void TrackerSession::complete(Processed& processed, const std::optional<geometry::Rectangle>& request) {
  passGate(processed);
  const ros::Time stamp = processed.header.stamp;
  const bool had_roi = tracker_.hasRoi();
  bool new_reference = false;
  robot_step_ = 0.0;
  processed.result = track(processed, request, new_reference);
  const tracking::TrackResult found = processed.result;
  watchPicture(processed);
  judgeSelection(found, processed);
  before_ = found;
  if (had_roi && !tracker_.hasRoi()) ++epoch_;
  if (!tracker_.hasRoi() && recall_.due() == nullptr) recall_.end(processed.result.reason);
  recall_.see(processed.result);
  processed.recall = recall_.text();
  if (processed.result.state == tracking::State::kTracking && processed.repeats.region == 0) believed_stamp_ = stamp;
  if (!tracker_.hasRoi()) believed_stamp_.reset();
  image_size_ = processed.image.size();
  if (processed.result.selected_now) {
    reference_stamp_ = stamp;
    reference_ = Reference{processed.image.clone(), processed.result.roi, stamp};
  }
  if (tracker_.hasRoi()) {
    const geometry::Quadrilateral corners = geometry::apply(found.g, found.roi.corners());
    processed.mask_share = tracking::coveredShare(processed.external_mask.mask, onSensor(corners));
  }
  processed.reference_stamp = reference_stamp_;
  intrinsics_.update(processed.image.size(), new_reference || !tracker_.hasRoi());
  processed.camera = intrinsics_.camera();
  processed.camera_error = intrinsics_.error();
  if (!lens_error_.empty()) {
    processed.camera.reset();
    processed.camera_error = lens_error_;
  }
  processed.lens = lens_;
}

// Homography of the ego-motion from the last image in state TRACKING to this one, for a plane parallel to the image.
std::optional<Eigen::Matrix3d> TrackerSession::motionBefore(Processed& processed) {
  const ros::Time& stamp = processed.header.stamp;
  if (!camera_motion_ || !believed_stamp_ || !tracker_.hasRoi() || !(stamp > *believed_stamp_)) return std::nullopt;
  processed.motion_wanted = true;
  // The camera of the last image; if the camera changes, tracking ends.
  const std::optional<geometry::PinholeCamera>& camera = intrinsics_.camera();
  if (!camera) {
    processed.motion_error = "no intrinsics: " + intrinsics_.error();
    return std::nullopt;
  }
  auto motion = camera_motion_(processed.header.frame_id, *believed_stamp_, stamp, processed.motion_error);
  if (!motion) return std::nullopt;
  if (lens_) {  // the rectified camera is rotated relative to the camera frame in tf
    const Eigen::Isometry3d turn(lens_->parameters().rotation);
    motion = turn * *motion * turn.inverse();
  }
  try {
    const Eigen::Matrix3d pixels =
        geometry::pixelsFromPlane(*motion, Eigen::Vector3d::UnitZ(), parameters_.robot_motion.depth, *camera);
    const geometry::Quadrilateral corners = geometry::apply(before_.g, before_.roi.corners());
    const geometry::Quadrilateral moved = geometry::apply(pixels, corners);
    robot_step_ = std::max(robot_step_, geometry::largestDistance(moved, corners));
    return pixels;
  } catch (const std::invalid_argument& error) {
    processed.motion_error = error.what();
    return std::nullopt;
  }
}

void TrackerSession::updateLens(const cv::Size& size) {
  if (parameters_.imageKind() != ImageKind::kToRectify) return;
  const std::shared_ptr<const image::Lens>& lens = lens_source_.lensFor(size);
  lens_error_ = lens ? "" : "images cannot be rectified: " + lens_source_.error();
  if (!lens || lens == lens_) return;
  recall_.end("the lens changed");
  reference_.reset();
  tracker_.setLens(*lens);
  lens_ = lens;
}

// Makes a view of a recall the reference. Returns true if this image's camera counts as that of the reference, which is
// so for the first view only: if the intrinsics change on the way, H becomes invalid.
bool TrackerSession::takeDueView(double time) {
  const RecallStep* step = recall_.due();
  if (step == nullptr || !lens_error_.empty()) return false;
  try {
    tracker_.recall(step->view.image, step->stamp.toSec(), step->view.roi, time);
  } catch (const std::invalid_argument& error) {
    recall_.end(error.what());
    return false;
  }
  recall_.taken();
  reference_ = Reference{step->view.image, step->view.roi, step->stamp};
  start_roi_pending_ = false;
  trial_ends_.reset();
  trial_failed_ = false;
  believed_stamp_.reset();
  reference_stamp_ = step->stamp;
  return recall_.first();
}

tracking::TrackResult TrackerSession::track(Processed& processed, const std::optional<geometry::Rectangle>& request,
                                            bool& new_reference) {
  const bool from_parameters = !request && start_roi_pending_ && recall_.due() == nullptr;
  updateLens(processed.image.size());
  if (mask_source_) processed.external_mask = mask_source_(processed.image, processed.header.stamp);
  const cv::Mat& mask = processed.external_mask.mask;
  if (!lens_error_.empty()) {
    if (request || from_parameters) processed.selection_error = lens_error_;
  } else if (request || from_parameters) {
    try {
      const auto result = tracker_.select(processed.image, intake_.time(), request ? *request : *parameters_.roi, mask);
      start_roi_pending_ = start_roi_refused_ = false;
      recall_.end("a region was selected");
      ++epoch_;
      new_reference = true;
      return result;
    } catch (const std::invalid_argument& error) {
      // The parameters' ROI stays pending: the first images of a camera may be black.
      processed.selection_error = error.what();
      const geometry::Rectangle& wanted = request ? *request : *parameters_.roi;
      processed.selection_error += maskText(mask, wanted);
      if (request || !start_roi_refused_)
        processed.selection_error += proposalText(regionThatWouldDo(tracker_, processed.image, wanted));
      if (from_parameters) start_roi_refused_ = true;
    }
  }
  const bool had_roi = tracker_.hasRoi();
  if (takeDueView(intake_.time())) new_reference = true;
  tracking::TrackResult result = tracker_.track(processed.image, intake_.time(), motionBefore(processed), mask);
  if (!lens_error_.empty() && !had_roi) result.reason = lens_error_;
  if (!processed.selection_error.empty() && result.state == tracking::State::kIdle) {
    result.reason = "the ROI could not be selected: " + processed.selection_error;
  }
  return result;
}

// How much of a region that was refused is covered; empty: nothing.
std::string TrackerSession::maskText(const cv::Mat& mask, const geometry::Rectangle& roi) const {
  const double share = tracking::coveredShare(mask, onSensor(roi.corners()));
  if (share == 0.0) return "";
  return "; the external mask covers " + std::to_string(std::lround(100.0 * share)) + " % of it";
}

cv::Mat TrackerSession::occlusionMask() const {
  const cv::Mat mask = tracker_.occlusionMask();
  return mask.empty() ? cv::Mat(cv::Mat::zeros(image_size_, CV_8UC1)) : mask;
}

Snapshot TrackerSession::snapshot(const Processed& processed) const {
  Snapshot result;
  result.image = processed.image.clone();
  result.stamp = processed.header.stamp;
  result.camera = processed.camera;
  result.lens = processed.lens;
  result.lens_error = lens_error_;
  result.epoch = epoch_;
  const tracking::TrackResult& now = processed.result;
  std::ostringstream why;
  why.precision(2);
  if (now.state != tracking::State::kTracking) {
    why << "no view can be stored while the tracker is " << tracking::stateName(now.state) << ": " << now.reason;
  } else if (!(now.visible_fraction >= parameters_.views.min_visible_fraction)) {
    why << "visible fraction " << now.visible_fraction << ", expected at least "
        << parameters_.views.min_visible_fraction << " while a view is stored";
  } else {
    const cv::Rect whole(cv::Point(0, 0), processed.image.size());
    try {
      result.roi = tracking::uprightRoi(
          now.g, now.roi, processed.lens ? image::rectifiedBox(*processed.lens, processed.image.size()) : whole);
    } catch (const std::invalid_argument& error) {
      why << error.what();
    }
  }
  result.roi_error = why.str();
  return result;
}

std::shared_ptr<const Snapshot> TrackerSession::reference() const {
  if (!reference_ || !tracker_.hasRoi()) return nullptr;
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->image = reference_->image;
  snapshot->stamp = reference_->stamp;
  snapshot->lens = lens_;  // another lens forgets the reference
  snapshot->epoch = epoch_;
  return snapshot;
}

std::string TrackerSession::recall(const RecallRoute& route) {
  if (route.steps.empty()) return "the way to the view is empty";
  if (route.epoch != epoch_) return "a region was selected or forgotten in the meantime";
  recall_.begin(route.steps);
  ++epoch_;
  return "";
}

void TrackerSession::retune(const TrackerParameters& parameters) {
  parameters::copyWhatMayChange(parameters, parameters_);
  tracker_.retune(parameters_.tracking);
}

void TrackerSession::reset() {
  recall_.end("the tracker was reset");
  ++epoch_;
  tracker_.reset();
  reference_.reset();
  believed_stamp_.reset();
  start_roi_pending_ = false;
}

}  // namespace laparoscope_servo
