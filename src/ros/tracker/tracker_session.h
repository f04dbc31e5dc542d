// The tracker as ROS sees it: images and camera_info in, results that messages are made of out. The nodelet and the
// offline tool both use it, so that they give the same numbers. Not thread-safe.
#pragma once

#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Header.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/repeat_watch.h"
#include "laparoscope_servo/tracking/corner_path.h"
#include "laparoscope_servo/tracking/frozen_feed.h"
#include "laparoscope_servo/tracking/region_tracker.h"
#include "ros/tracker/camera_info.h"
#include "ros/tracker/image_gate.h"
#include "ros/tracker/tracker_parameters.h"
#include "ros/tracker/view_recall.h"

namespace laparoscope_servo {

// Where the camera was, for the tracker's prediction: the motion of `frame` from the image at `from` to that at `to`,
// or why not.
using CameraMotion = std::function<std::optional<Eigen::Isometry3d>(const std::string& frame, const ros::Time& from,
                                                                    const ros::Time& to, std::string& why)>;

// What is known of one image.
struct Processed {
  std_msgs::Header header;  // the image's
  cv::Mat image;            // as the tracker took it, 8UC1 or 8UC3; may share the data of the message
  tracking::TrackResult result;
  ros::Time reference_stamp;
  std::optional<geometry::PinholeCamera> camera;  // empty when H cannot be given
  std::string camera_error;                       // why it cannot
  std::shared_ptr<const image::Lens> lens;        // through which the image is seen; null: none
  bool motion_wanted = false;                     // the camera's motion was asked for
  std::string motion_error;                       // why it was not given
  std::string selection_error;                    // a ROI should have been selected in this image and was not: why
  std::string recall = "none";                    // of a stored view: see ViewRecall::text
  image::Repeats repeats;                         // of the picture
  double period = 0.0;                            // s since the image before
  double processing_time = 0.0;                   // s, from the decoded image to the result
};

class TrackerSession {
 public:
  // `parameters` without errors; throws std::invalid_argument otherwise. The ROI of the parameters is selected in the
  // first image where that is possible, until another one is selected or reset() is called. When time begins again (a
  // looped bag), the region is looked for as it was when it was selected.
  explicit TrackerSession(const TrackerParameters& parameters);

  // Holds for the images that follow. While the tracker rectifies, a lens that differs from the one before ends
  // tracking; camera_info that cannot be used leaves the lens as it is, and takes H away.
  void setCameraInfo(const sensor_msgs::CameraInfo& info) {
    intrinsics_.set(info);
    lens_source_.set(info);
  }

  // Asked while a ROI is tracked or searched for, at most once an image.
  void setCameraMotion(const CameraMotion& motion) { camera_motion_ = motion; }

  // Processes the next image; `request` is a ROI to select in it. Throws ImageError or std::invalid_argument when the
  // image cannot be used, or is not the next one (see ImageGate): the session then goes on as if it had not come. The
  // message has to outlive the result's image. A picture that repeats (see FrozenFeed) is never TRACKING.
  Processed process(const sensor_msgs::Image& message,
                    const std::optional<geometry::Rectangle>& request = std::nullopt);
  // The same for an image that OpenCV decoded.
  Processed process(const cv::Mat& decoded, const std_msgs::Header& header,
                    const std::optional<geometry::Rectangle>& request = std::nullopt);

  // What was processed last, with the tracked ROI where it is now: the picture as the surgeon sees it.
  Snapshot snapshot(const Processed& processed) const;
  // From the next image on: each view of the way is the reference until it has been reached; the last one stays.
  // Returns why not: something else was selected, or the session was reset, after the image that the way was planned
  // from.
  std::string recall(const RecallRoute& route);

  // From the next image on, the parameters that may change while the tracker runs; the others stay. What is tracked
  // stays, too.
  void retune(const TrackerParameters& parameters);

  // ROS time has jumped back: a loop is believed with its first image.
  void clockJumpedBack() { gate_.clockJumpedBack(); }

  // Forgets the ROI, also that of the parameters, and ends a recall.
  void reset();

  // Of the image processed last, with its size: see tracking::RegionTracker. All 0 while no ROI is selected.
  cv::Mat occlusionMask() const;
  // The camera has a lens distortion that nobody has taken out of the images.
  bool ignoresDistortion() const { return intrinsics_.ignoresDistortion(); }
  const TrackerParameters& parameters() const { return parameters_; }

 private:
  // The image that the region was selected in, for when it has to be found again.
  struct Reference {
    cv::Mat image;
    geometry::Rectangle roi;
    ros::Time stamp;
  };

  void passGate(const Processed& processed, double& period);
  void lookForReference(const std::string& why);
  geometry::Quadrilateral onSensor(geometry::Quadrilateral corners) const;
  void watchPicture(Processed& processed);
  void judgeSelection(const tracking::TrackResult& found, tracking::TrackResult& result);
  std::string turnedTooFast(const tracking::TrackResult& result) const;
  tracking::TrackResult track(Processed& processed, const std::optional<geometry::Rectangle>& request,
                              bool& new_reference);
  bool takeDueView(double time);
  void updateLens(const cv::Size& size);
  std::optional<Eigen::Matrix3d> motionBefore(Processed& processed);
  void complete(Processed& processed, const std::optional<geometry::Rectangle>& request);

  TrackerParameters parameters_;
  tracking::RegionTracker tracker_;
  ViewRecall recall_;
  std::uint64_t epoch_ = 0;  // selections and resets until now
  Intrinsics intrinsics_;
  LensSource lens_source_;
  std::shared_ptr<const image::Lens> lens_;  // in force
  std::string lens_error_;                   // why the newest camera_info gives none, and nothing can be selected
  bool start_roi_pending_ = false;           // the parameters' ROI waits for its image
  bool start_roi_refused_ = false;           // it was refused once
  std::optional<double> trial_ends_;         // s, the tracker's time: until then a new region is on trial
  std::string trial_failed_;                 // what is said of a region that did not pass; empty otherwise
  BitDepth depth_;
  ImageGate gate_;
  cv::Rect box_;  // px, of the image as it comes: about the region where it was tracked last
  tracking::CornerPath path_;
  image::RepeatWatch repeats_;
  tracking::FrozenFeed feed_;
  double time_offset_ = 0.0;  // s, from stamps to the tracker's time, which never goes back
  double time_ = 0.0;         // s, the tracker's
  std::optional<Reference> reference_;
  tracking::TrackResult before_;  // the tracker's word of the image before
  double robot_step_ = 0.0;       // px, see FrozenFeed
  cv::Size image_size_;
  ros::Time reference_stamp_;
  CameraMotion camera_motion_;
  std::optional<ros::Time> believed_stamp_;  // of the last new picture that the state was TRACKING in
  double believed_time_ = 0.0;               // s, the tracker's, of the last image that the state was TRACKING in
  double believed_angle_ = 0.0;              // rad, of the region in it
};

}  // namespace laparoscope_servo
