// The node `video_player`: plays a bag, a video or a folder of images as a camera driver would publish them, and the
// time that goes with them as `rosbag play --clock` would.
//
// Subscribes: homography (laparoscope_servo/Homography), in lockstep only. Publishes: image_raw (sensor_msgs/Image),
// camera_info (sensor_msgs/CameraInfo; all zero if no calibration is known), and /clock. Of a bag with results of a
// tracker, also recorded_homography, just before the image of each. A bag's images keep their headers, except for
// stamps that are 0 or repeated, since a result is identified by its image's stamp. Stamps of a video are first_stamp +
// presentation time, at any playback speed. A steady clock sets the pace. At a loop, time jumps back as with a looped
// bag. Only images, camera_info and those results of a bag are played, so that no recorded message can move an arm.
//
// Service ~control (ControlPlayback): pause, step, seek, again. Topic ~state (PlaybackState), latched. While it holds
// at an image and nothing is tracked, that image is published repeatedly, with stamps a microsecond apart, so that a
// region can be selected in it.
#pragma once

#include <laparoscope_servo/ControlPlayback.h>
#include <laparoscope_servo/PlaybackState.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "ros/playback/image_source.h"
#include "ros/playback/playback_control.h"
#include "ros/playback/playback_pace.h"
#include "ros/playback/player_output.h"
#include "ros/playback/video_player_config.h"

namespace laparoscope_servo {

class VideoPlayer {
 public:
  // Throws std::runtime_error when the calibration cannot be read.
  VideoPlayer(ros::NodeHandle node, const VideoPlayerConfig& config);

  // Plays until the end of the video or of the node. Throws SourceError if the video cannot be opened, is damaged or
  // has no images, std::runtime_error if the calibration is for images of another size. With a screen and `stay` it
  // first says what is wrong on ~state, where it can be read and tried once more, until the node ends.
  void run();

 private:
  using Clock = std::chrono::steady_clock;

  void open(double start);
  void play();
  void fail(const SourceError& error);
  void waitForSubscribers() const;
  void playOnce();
  // Returns false if the position in the recording has changed.
  bool mayPlay();
  void reopen(double start);
  void tellState();
  bool waitForAgain();
  void waitUntil(const ros::Time& time);
  void waitForResult(const ros::Time& time);
  void tellNotes() const;
  // The time on /clock for the image.
  ros::Time timeOf(const SourceImage& image) const;

  VideoPlayerConfig config_;
  SourceOptions options_;
  std::unique_ptr<ImageSource> source_;
  PlayerOutput output_;
  PlaybackPace pace_;
  ros::Subscriber homography_subscriber_;
  PlaybackControl control_;
  ros::CallbackQueue control_queue_;
  ros::NodeHandle control_node_;
  ros::Publisher state_publisher_;
  ros::ServiceServer control_server_;
  ros::AsyncSpinner control_spinner_;
  PlaybackState told_;
  Clock::time_point told_at_;
  std::string failure_;  // why the recording cannot be read; empty: it can
  bool opened_ = false;  // since the start
  bool told_notes_ = false;
  double from_ = 0.0;                 // s: where it is opened after a failure
  double position_ = 0.0;             // s
  bool sought_ = false;               // no image since a change of position
  bool rebase_ = false;               // the next image is due at once
  bool tracked_ = false;              // a region is tracked
  ros::Time awaited_;                 // stamp of the last published image ...
  bool answered_ = false;             // ... and whether its result has come
  std::size_t unanswered_ = 0;        // number of images for which no result came
  ros::Duration offset_;              // added to the stamps of the source
  std::optional<ros::Time> goes_on_;  // after a loop at which time does not jump: that of the next image
  ros::Time last_;                    // time on /clock of the last image
};

}  // namespace laparoscope_servo
