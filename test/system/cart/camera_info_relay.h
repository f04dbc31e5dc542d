// What lies between camera and trackers beside the images: passes camera_info on, as it is or changed.
#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>

#include <functional>
#include <mutex>
#include <string>

namespace laparoscope_servo::test {

class CameraInfoRelay {
 public:
  // Called with each message, in the relay's thread; the result is passed on.
  using Fault = std::function<sensor_msgs::CameraInfo(sensor_msgs::CameraInfo)>;

  // From topic to topic. It runs in a thread of its own.
  CameraInfoRelay(const std::string& from, const std::string& to);
  ~CameraInfoRelay();

  // In place of one that has begun before.
  void begin(const Fault& fault);
  // Passes nothing on.
  void cut();
  void end();

 private:
  void onInfo(const sensor_msgs::CameraInfo& info);

  std::mutex mutex_;
  Fault fault_;
  bool cut_ = false;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  ros::AsyncSpinner spinner_;
};

// Focal lengths by this factor.
CameraInfoRelay::Fault withFocalLength(double factor);
// The principal point by so many pixels to the right and down.
CameraInfoRelay::Fault withPrincipalPoint(double right, double down);
// Every second one is changed.
CameraInfoRelay::Fault onEverySecond(const CameraInfoRelay::Fault& fault);

}  // namespace laparoscope_servo::test
