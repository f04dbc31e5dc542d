// What the player of recordings publishes: image_raw, camera_info, /clock, and the results of a tracker that were
// recorded with the images.
#pragma once

#include <image_transport/image_transport.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>

#include <chrono>
#include <memory>
#include <string>

#include "ros/playback/image_source.h"
#include "ros/playback/recorded_results.h"
#include "ros/playback/video_player_config.h"

namespace laparoscope_servo {

class PlayerOutput {
 public:
  // Throws std::runtime_error when the calibration cannot be read.
  PlayerOutput(ros::NodeHandle node, const VideoPlayerConfig& config);

  // Looks for recorded results. They are published from now on, each in front of its image.
  void openResults();

  void publishClock(const ros::Time& time);
  // publishClock() for the time of an image.
  void setTime(const ros::Time& time);
  // The time of the last image, or of its last repetition.
  const ros::Time& time() const { return time_; }

  // `offset` is added to all stamps; `keeps_frame`: the image has a frame of its own. Throws std::runtime_error if the
  // calibration is for images of another size.
  void publish(const SourceImage& image, const ros::Duration& offset, bool keeps_frame);
  // Publishes the last image again now and then, with stamps and times a microsecond apart, for whoever looks at it
  // while it stands.
  void repeat();

  std::size_t published() const { return published_; }  // images, repetitions aside
  std::string topic() const { return image_publisher_.getTopic(); }
  int subscribers() const { return static_cast<int>(image_publisher_.getNumSubscribers()); }
  bool isCameraInfoSubscribed() const { return camera_info_publisher_.getNumSubscribers() > 0; }

 private:
  using Clock = std::chrono::steady_clock;

  void publishRecorded(const SourceImage& image, const ros::Duration& offset);
  void takeCameraInfo(const SourceImage& image, const sensor_msgs::Image& message);

  ros::NodeHandle node_;
  VideoPlayerConfig config_;
  image_transport::ImageTransport transport_;
  // Not a CameraPublisher, which does not count the subscribers of the images alone.
  image_transport::Publisher image_publisher_;
  ros::Publisher camera_info_publisher_;
  ros::Publisher clock_publisher_;
  ros::Publisher recorded_publisher_;
  std::unique_ptr<RecordedResults> recorded_;  // null: not looked for yet
  sensor_msgs::CameraInfo camera_info_;
  sensor_msgs::ImagePtr last_;   // the image that was published last
  Clock::time_point repeat_at_;  // when it is published again
  ros::Time time_;
  std::size_t published_ = 0;
};

}  // namespace laparoscope_servo
