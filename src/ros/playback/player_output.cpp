#include "ros/playback/player_output.h"

#include <image_transport/camera_common.h>
#include <rosgraph_msgs/Clock.h>

#include <boost/make_shared.hpp>
#include <stdexcept>

#include "laparoscope_servo/Homography.h"
#include "ros/tracker/camera_info.h"
#include "ros/tracker/image_conversion.h"
#include "ros/tracker/result_messages.h"

namespace laparoscope_servo {

namespace {

constexpr std::chrono::milliseconds kRepeatPeriod(200);
const ros::Duration kRepeatStep(0, 1000);  // step of repeated stamps; 40,000 fit between two images of a film

}  // namespace

PlayerOutput::PlayerOutput(ros::NodeHandle node, const VideoPlayerConfig& config)
    : node_(node), config_(config), transport_(node) {
  if (!config.camera_info.empty()) camera_info_ = readCameraInfo(config.camera_info);
  if (config.clock) clock_publisher_ = node.advertise<rosgraph_msgs::Clock>("/clock", 10);
  // The queue is long enough for a burst of images after a slow read.
  image_publisher_ = transport_.advertise("image_raw", 50);
  const std::string info_topic = image_transport::getCameraInfoTopic(node.resolveName("image_raw"));
  camera_info_publisher_ = node.advertise<sensor_msgs::CameraInfo>(info_topic, 50);
}

void PlayerOutput::openResults() {
  recorded_ = std::make_unique<RecordedResults>(inputsOf(config_.video), config_.image_topic);
  if (recorded_->any()) recorded_publisher_ = node_.advertise<Homography>("recorded_homography", 50);
}

void PlayerOutput::publishClock(const ros::Time& time) {
  if (!config_.clock) return;
  rosgraph_msgs::Clock message;
  message.clock = time;
  clock_publisher_.publish(message);
}

void PlayerOutput::setTime(const ros::Time& time) {
  time_ = time;
  publishClock(time);
}

void PlayerOutput::publish(const SourceImage& image, const ros::Duration& offset, bool keeps_frame) {
  publishRecorded(image, offset);
  std_msgs::Header header = image.header;
  header.stamp += offset;
  if (!keeps_frame) header.frame_id = config_.frame_id;
  sensor_msgs::ImagePtr message;
  if (image.message) {
    message = boost::make_shared<sensor_msgs::Image>(*image.message);
    message->header = header;
  } else {
    message = imageMessage(header, trackerImage(image.decoded));
  }
  takeCameraInfo(image, *message);
  camera_info_.header = header;
  camera_info_publisher_.publish(camera_info_);
  image_publisher_.publish(message);
  last_ = message;
  repeat_at_ = Clock::now() + kRepeatPeriod;
  ++published_;
}

// With the image's stamp as it is played.
void PlayerOutput::publishRecorded(const SourceImage& image, const ros::Duration& offset) {
  const HomographyConstPtr recorded = recorded_ ? recorded_->at(image.header.stamp, image.record_time) : nullptr;
  if (!recorded) return;
  Homography result = *recorded;
  result.header.stamp += offset;
  recorded_publisher_.publish(result);
}

void PlayerOutput::takeCameraInfo(const SourceImage& image, const sensor_msgs::Image& message) {
  if (config_.camera_info.empty()) {
    if (image.camera_info) camera_info_ = *image.camera_info;
    if (camera_info_.K[0] == 0.0) {
      camera_info_.width = message.width;
      camera_info_.height = message.height;
    }
  } else if (camera_info_.width != message.width || camera_info_.height != message.height) {
    throw std::runtime_error("calibration '" + config_.camera_info + "' is for images of " +
                             std::to_string(camera_info_.width) + "x" + std::to_string(camera_info_.height) +
                             " px, but those of '" + config_.video + "' have " + std::to_string(message.width) + "x" +
                             std::to_string(message.height) + " px");
  }
}

void PlayerOutput::repeat() {
  if (!last_ || Clock::now() < repeat_at_) return;
  repeat_at_ = Clock::now() + kRepeatPeriod;
  last_ = boost::make_shared<sensor_msgs::Image>(*last_);
  last_->header.stamp += kRepeatStep;
  setTime(time_ + kRepeatStep);
  camera_info_.header = last_->header;
  camera_info_publisher_.publish(camera_info_);
  image_publisher_.publish(last_);
}

}  // namespace laparoscope_servo
