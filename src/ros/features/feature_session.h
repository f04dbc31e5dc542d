// A tracker of features for ROS: takes images and camera_info, returns what the messages say. The nodelets and the
// offline tool both use it, so that their results are equal. Not thread-safe.
#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Header.h>

#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "laparoscope_servo/features/feature_tracker.h"
#include "laparoscope_servo/image/repeat_watch.h"
#include "laparoscope_servo/tracking/frozen_feed.h"
#include "ros/features/feature_parameters.h"
#include "ros/tracker/camera_info.h"
#include "ros/tracker/image_intake.h"
#include "ros/tracker/robot_motion.h"

namespace laparoscope_servo {

// The result for one image.
struct ProcessedFeatures {
  std_msgs::Header header;  // header of the image
  cv::Mat image;            // as tracked, 8UC1 or 8UC3; may share the data of the message
  features::TrackedFeatures result;
  bool selected_now = false;
  ros::Time selection_stamp;     // of the image in which the features were selected; zero: in none
  std::string selection_error;   // why what was requested, or is in the file, was not selected; else empty
  std::string camera_error;      // why there are no intrinsics; else empty
  std::string motion_error;      // why the camera's motion is not known, where it was asked for; else empty
  image::Repeats repeats;        // repeats of the picture
  double period = 0.0;           // s since the last image
  double processing_time = 0.0;  // s, from the decoded image to the result
};

class FeatureSession {
 public:
  // The file of `input`, if there is one, is selected in the first image in which that is possible, unless something
  // else was selected or reset() was called before. Throws std::invalid_argument if the file cannot be read.
  FeatureSession(const FeatureInput& input, std::unique_ptr<features::FeatureTracker> tracker);

  // Holds for the following images.
  void setCameraInfo(const sensor_msgs::CameraInfo& info) { intrinsics_.set(info); }

  // The camera's motion for the prediction. Pixels move with it as those of a plane parallel to the image, at the depth
  // that the input's robot_motion has.
  void setCameraMotion(const CameraMotion& motion) { camera_motion_ = motion; }

  // Processes the next image; `request` is selected in it. Throws ImageError or std::invalid_argument if the image
  // cannot be used, or does not continue the sequence (see ImageGate); the session is then unchanged. The message must
  // outlive the result's image. If the feed is frozen (see FrozenFeed), TRACKING is lowered to SEARCHING. If time
  // begins again, the features are forgotten, and those of the file selected again.
  ProcessedFeatures process(const sensor_msgs::Image& message,
                            const std::optional<features::FeatureSelection>& request = std::nullopt);
  // What is to be told of an image that process() refused because of its size: no feature was seen in it. Has neither
  // an image nor times; the session is unchanged.
  ProcessedFeatures notSeen(const std_msgs::Header& header, const std::string& why) const;
  // Processes an image decoded by OpenCV.
  ProcessedFeatures process(const cv::Mat& decoded, const std_msgs::Header& header,
                            const std::optional<features::FeatureSelection>& request = std::nullopt);

  // See features::FeatureTracker.
  bool givesPoses() const { return tracker_->givesPoses(); }
  bool findsByItself() const { return tracker_->findsByItself(); }
  bool takesSelection() const { return tracker_->takesSelection(); }
  bool givesMask() const { return tracker_->givesMask(); }
  cv::Mat mask() const { return tracker_->mask(); }

  // Call if ROS time has jumped back: a loop is then accepted with its first image.
  void clockJumpedBack() { intake_.clockJumpedBack(); }
  // Forgets the features, also those of the file.
  void reset();

 private:
  void complete(ProcessedFeatures& processed, const std::optional<features::FeatureSelection>& request);
  void track(ProcessedFeatures& processed, const std::optional<features::FeatureSelection>& request);
  void expectMotion(ProcessedFeatures& processed, features::FeaturePrior& prior) const;
  void watchPicture(ProcessedFeatures& processed);

  std::unique_ptr<features::FeatureTracker> tracker_;
  ImageIntake intake_;
  Intrinsics intrinsics_;
  std::optional<features::FeatureSelection> from_file_;
  bool file_pending_ = false;      // it is to be selected in the next image
  bool file_selected_ = false;     // what is tracked was selected by it
  bool time_began_again_ = false;  // since the last selection
  CameraMotion camera_motion_;
  double depth_;                         // m, see setCameraMotion()
  std::optional<ros::Time> last_stamp_;  // from which the motion is asked for; empty: nothing was seen yet
  ros::Time selection_stamp_;
  image::RepeatWatch repeats_;
  tracking::FrozenFeed feed_;
};

}  // namespace laparoscope_servo
