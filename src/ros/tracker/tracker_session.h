// The tracker for ROS: takes images and camera_info, returns the results for the messages. The nodelet and the offline
// tool both use it, so that their results are equal. Not thread-safe.
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
#include "laparoscope_servo/tracking/external_masks.h"
#include "laparoscope_servo/tracking/frozen_feed.h"
#include "laparoscope_servo/tracking/region_tracker.h"
#include "ros/tracker/camera_info.h"
#include "ros/tracker/image_intake.h"
#include "ros/tracker/tracker_parameters.h"
#include "ros/tracker/view_recall.h"

namespace laparoscope_servo {

// What is known to cover the tissue in an image; the mask is empty where nothing is known.
using MaskSource = std::function<tracking::ExternalMask(const cv::Mat& image, const ros::Time& stamp)>;

// The result for one image.
struct Processed {
  std_msgs::Header header;  // header of the image
  cv::Mat image;            // the image as tracked, 8UC1 or 8UC3; may share the data of the message
  tracking::TrackResult result;
  ros::Time reference_stamp;
  std::optional<geometry::PinholeCamera> camera;  // intrinsics; empty if H cannot be computed
  std::string camera_error;                       // why there are no intrinsics
  std::shared_ptr<const image::Lens> lens;        // lens of the image; null: none
  bool motion_wanted = false;                     // the camera's motion was requested
  std::string motion_error;                       // why it was not available
  tracking::ExternalMask external_mask;           // as it was used; its pixels last until the next image
  double mask_share = 0.0;                        // 0 to 1, of the region: covered by it
  std::string selection_error;                    // why a requested ROI was not selected in this image; else empty
  // px, in the image of reference_stamp: would do where the selected region was not held in its first second
  std::optional<geometry::Rectangle> proposal;
  std::string recall = "none";   // recall of a stored view, see ViewRecall::text
  image::Repeats repeats;        // repeats of the picture
  double period = 0.0;           // s since the last image
  double processing_time = 0.0;  // s, from the decoded image to the result
};

class TrackerSession {
 public:
  // Throws std::invalid_argument if `parameters` has errors. The ROI of the parameters is selected in the first image
  // in which that is possible, unless another one was selected or reset() was called before. If time begins again (a
  // looped bag), the region is searched with its original reference.
  explicit TrackerSession(const TrackerParameters& parameters);

  // Sets camera_info for the following images. While the tracker rectifies, a different lens ends tracking; unusable
  // camera_info does not change the lens, but makes H invalid.
  void setCameraInfo(const sensor_msgs::CameraInfo& info) {
    intrinsics_.set(info);
    lens_source_.set(info);
  }

  // Called at most once per image, while a ROI is tracked or searched.
  void setCameraMotion(const CameraMotion& motion) { camera_motion_ = motion; }

  // Called once for each image that is processed.
  void setMaskSource(const MaskSource& source) { mask_source_ = source; }

  // Processes the next image; `request` is a ROI to select in it. Throws ImageError or std::invalid_argument if the
  // image cannot be used, or does not continue the sequence (see ImageGate); the session is then unchanged. The message
  // must outlive the result's image. After tracking, checks of the pictures may lower TRACKING to SEARCHING: if the
  // feed is frozen (see FrozenFeed), or the region was found again turned too far.
  Processed process(const sensor_msgs::Image& message,
                    const std::optional<geometry::Rectangle>& request = std::nullopt);
  // Processes an image decoded by OpenCV.
  Processed process(const cv::Mat& decoded, const std_msgs::Header& header,
                    const std::optional<geometry::Rectangle>& request = std::nullopt);

  // The last image with the present place of the tracked ROI.
  Snapshot snapshot(const Processed& processed) const;
  // The image in which the present region was selected, or that of the view that was recalled; null: there is none. Its
  // pixels are not changed any more.
  std::shared_ptr<const Snapshot> reference() const;
  // Of the image in which the present or last region was selected, or of the view that was recalled; zero: none was.
  ros::Time referenceStamp() const { return reference_stamp_; }
  // Starts a recall with the next image: each view of the way is the reference until it is reached; the last one stays.
  // Returns why it is refused: a ROI was selected, or the session was reset, after the image from which the way was
  // planned.
  std::string recall(const RecallRoute& route);

  // Takes the parameters that may change while the tracker runs, from the next image on. Tracking goes on.
  void retune(const TrackerParameters& parameters);

  // Call if ROS time has jumped back: a loop is then accepted with its first image.
  void clockJumpedBack() { intake_.clockJumpedBack(); }

  // Forgets the ROI, also that of the parameters, and ends a recall.
  void reset();

  // Mask of the last image, of its size: see tracking::RegionTracker. All 0 while no ROI is selected.
  cv::Mat occlusionMask() const;
  // Whether the camera has lens distortion that is not corrected in the images.
  bool ignoresDistortion() const { return intrinsics_.ignoresDistortion(); }
  const TrackerParameters& parameters() const { return parameters_; }

 private:
  // The image in which the region was selected, for a new search.
  struct Reference {
    cv::Mat image;
    geometry::Rectangle roi;
    ros::Time stamp;
  };

  void passGate(Processed& processed);
  void lookForReference(const std::string& why);
  geometry::Quadrilateral onSensor(geometry::Quadrilateral corners) const;
  void watchPicture(Processed& processed);
  void judgeSelection(const tracking::TrackResult& found, Processed& processed);
  std::string turnedTooFast(const tracking::TrackResult& result) const;
  tracking::TrackResult track(Processed& processed, const std::optional<geometry::Rectangle>& request,
                              bool& new_reference);
  bool takeDueView(double time);
  void updateLens(const cv::Size& size);
  std::optional<Eigen::Matrix3d> motionBefore(Processed& processed);
  std::string maskText(const cv::Mat& mask, const geometry::Rectangle& roi) const;
  void complete(Processed& processed, const std::optional<geometry::Rectangle>& request);

  TrackerParameters parameters_;
  tracking::RegionTracker tracker_;
  ViewRecall recall_;
  std::uint64_t epoch_ = 0;  // number of selections and resets
  Intrinsics intrinsics_;
  LensSource lens_source_;
  std::shared_ptr<const image::Lens> lens_;  // the present lens
  std::string lens_error_;                   // why the newest camera_info has no lens, so that no ROI can be selected
  bool start_roi_pending_ = false;           // the parameters' ROI is not selected yet
  bool start_roi_refused_ = false;           // it was refused in an image before
  std::optional<double> trial_ends_;         // s, tracker time, end of a new region's trial
  bool lost_covered_ = false;                // the last loss was one of visibility
  bool trial_failed_ = false;                // the region was not held in its first second, and is not TRACKING since
  std::optional<geometry::Rectangle> trial_proposal_;  // px, in the image of its selection: what would do instead
  ImageIntake intake_;
  cv::Rect box_;  // px, in the raw image: box around the region where it was last tracked
  tracking::CornerPath path_;
  image::RepeatWatch repeats_;
  tracking::FrozenFeed feed_;
  std::optional<Reference> reference_;
  tracking::TrackResult before_;  // the tracker's result for the last image
  double robot_step_ = 0.0;       // px, see FrozenFeed
  cv::Size image_size_;
  ros::Time reference_stamp_;
  CameraMotion camera_motion_;
  MaskSource mask_source_;
  std::optional<ros::Time> believed_stamp_;  // stamp of the last new picture in state TRACKING
  double believed_time_ = 0.0;               // s, tracker's time of the last image in state TRACKING
  double believed_angle_ = 0.0;              // rad, angle of the region in that image
};

}  // namespace laparoscope_servo
