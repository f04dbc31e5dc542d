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

#include <image_transport/image_transport.h>
#include <laparoscope_servo/ControlPlayback.h>
#include <laparoscope_servo/PlaybackState.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>

#include <chrono>
#include <memory>
#include <string>

#include "laparoscope_servo/Homography.h"
#include "laparoscope_servo/parameters/table.h"
#include "ros/playback/image_source.h"
#include "ros/playback/playback_control.h"
#include "ros/playback/recorded_results.h"

namespace laparoscope_servo {

struct VideoPlayerConfig {
  std::string video;              // bag, video file, or folder of images; several bags: see inputsOf
  std::string folder;             // of relative paths; empty: the working directory
  std::string image_topic;        // of a bag; may be empty if it has only one topic with images
  std::string camera_info_topic;  // of a bag; empty: camera_info beside the images
  std::string camera_info;        // file of camera_calibration (YAML or INI); empty: intrinsics unknown
  std::string frame_id = "laparoscope_optical";
  double fps = 25.0;             // Hz, 0.1 to 1000, for a folder and for a video without a rate
  double speed = 1.0;            // 0.01 to 100: 2 plays twice as fast
  double start = 0.0;            // s, >= 0: images before are skipped
  double first_stamp = 1.0;      // s, > 0, of the video's first image; 0 means "no time" in ROS
  bool loop = false;             // starts again at the end
  bool stay = false;             // the node does not end with the video, so that the last image stays visible
  bool restart_time = true;      // false: stamps go on at a loop instead of jumping back
  bool clock = true;             // publishes /clock
  bool lockstep = false;         // the next image waits for the tracker's result, so that a slow tracker misses none
  bool hold = false;             // holds at the first image until a region is selected or the command to play comes
  bool wait_for_screen = false;  // waits for a subscriber of ~state before the first image, see also run()
  int subscribers = 1;           // 0 to 100: waits for this number of subscribers of image_raw before the first image
};

// Adds the rows of the private parameters.
void describe(parameters::Table& table, VideoPlayerConfig& config);
std::vector<std::string> validate(const VideoPlayerConfig& config);

class VideoPlayer {
 public:
  // Throws std::runtime_error when the calibration cannot be read.
  VideoPlayer(ros::NodeHandle node, const VideoPlayerConfig& config);

  // Plays until the end of the video or of the node. Throws SourceError if the video cannot be opened, is damaged or
  // has no images, std::runtime_error if the calibration is for images of another size. With a screen and `stay` it
  // first says what is wrong on ~state, where it can be read and tried once more, until the node ends.
  void run();

  std::size_t published() const { return published_; }

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
  void repeatHeld();
  void tellState();
  bool waitForAgain();
  void waitUntil(const ros::Time& time);
  Clock::time_point dueTime(const ros::Time& time) const;
  void publish(const SourceImage& image);
  void publishRecorded(const SourceImage& image);
  void publishClock(const ros::Time& time);
  void waitForResult(const ros::Time& time);
  void tellNotes() const;
  // The time on /clock for the image.
  ros::Time timeOf(const SourceImage& image) const;

  ros::NodeHandle node_;
  VideoPlayerConfig config_;
  SourceOptions options_;
  std::unique_ptr<ImageSource> source_;
  std::unique_ptr<RecordedResults> recorded_;
  sensor_msgs::CameraInfo camera_info_;
  image_transport::ImageTransport transport_;
  // Not a CameraPublisher, which does not count the subscribers of the images alone.
  image_transport::Publisher image_publisher_;
  ros::Publisher camera_info_publisher_;
  ros::Publisher clock_publisher_;
  ros::Publisher recorded_publisher_;
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
  bool begun_ = false;
  bool told_notes_ = false;
  double from_ = 0.0;           // s: where it is opened after a failure
  double position_ = 0.0;       // s
  sensor_msgs::ImagePtr held_;  // the image that was published last
  ros::Time held_time_;         // its time on /clock
  Clock::time_point held_due_;  // when it is published again
  bool sought_ = false;         // no image since a change of position
  bool rebase_ = false;         // the next image is due at once
  bool tracked_ = false;        // a region is tracked
  ros::Time awaited_;           // stamp of the last published image ...
  bool answered_ = false;       // ... and whether its result has come
  std::size_t published_ = 0;
  std::size_t unanswered_ = 0;   // number of images for which no result came
  ros::Duration offset_;         // added to the stamps of the source
  ros::Time begin_;              // start of the pace: time on /clock ...
  Clock::time_point begin_due_;  // ... and steady time
  ros::Time last_;               // time on /clock of the last image
};

}  // namespace laparoscope_servo
