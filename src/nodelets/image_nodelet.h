// What the nodelets of all trackers share: images and camera_info of one owner each, the clock, diagnostics, and that
// no error ends the manager, which may hold the camera driver.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <image_transport/image_transport.h>
#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <memory>
#include <string>
#include <vector>

#include "ros/common/name_turn.h"
#include "ros/tracker/feed_owner.h"
#include "ros/tracker/feed_statistics.h"
#include "ros/tracker/image_backlog.h"
#include "ros/tracker/image_conversion.h"
#include "ros/tracker/robot_motion.h"

namespace laparoscope_servo::nodelets {

class ImageNodelet : public nodelet::Nodelet {
 protected:
  static constexpr double kThrottle = 5.0;  // s between two lines of the log about the same kind of error

  // Reads the parameters. Returns all errors; with any the nodelet does not start. May throw, as all below.
  virtual std::vector<std::string> configure() = 0;
  // Advertises, and ends with subscribe().
  virtual void start() = 0;
  // Called once instead of start(), or when that throws.
  virtual void notStarted(const std::string&) {}

  // All from here on run in the nodelet's own single-threaded queue.
  virtual void process(const sensor_msgs::ImageConstPtr& message) = 0;
  virtual void takeCameraInfo(const sensor_msgs::CameraInfo& info) = 0;
  virtual void clockJumpedBack() = 0;
  // Called for an image that may be the first one of another camera; refused() follows. Says at once that nothing of
  // what is tracked was seen in it: the scope must not go on by the image before it until it is certain whose this is.
  virtual void notSeen(const sensor_msgs::Image& image, const std::string& why) = 0;
  // An image could not be used; it is logged already.
  virtual void refused(const std::string& error, Refusal cause) = 0;
  // Not called before start().
  virtual void diagnose(double now, const FeedPublishers& publishers,
                        diagnostic_updater::DiagnosticStatusWrapper& status) = 0;

  void subscribe();
  // The camera's motion by the robot's tf; what others say on tf goes to the log. Holds as long as the nodelet.
  CameraMotion followRobot(const RobotMotionConfig& config);
  // For process(), before the image is used. Throws ImageError, see checkStamp of ros/tracker/image_gate.h.
  void checkTime(const ros::Time& stamp, double max_ahead);
  // For checkStamp; zero in simulated time, which comes on its own topic, before or after what is stamped.
  static ros::Time clockOfStamps();

 private:
  void onInit() override;
  void standAside(const std::string& why);
  void imageCallback(const sensor_msgs::ImageConstPtr& message);
  // For the raw transport, with which the sender of an image is known.
  void rawImageCallback(const ros::MessageEvent<const sensor_msgs::Image>& event);
  void processOrTell(const sensor_msgs::ImageConstPtr& message);
  void leaveForLater(const sensor_msgs::ImageConstPtr& message);
  void cameraInfoCallback(const ros::MessageEvent<const sensor_msgs::CameraInfo>& event);
  void refuse(const std::string& error, Refusal cause = Refusal::kData);
  void fillDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status);

  NameTurn turn_;  // first: what is below ends before
  std::unique_ptr<diagnostic_updater::Updater> diagnostics_;
  bool started_ = false;
  std::string why_aside_;
  std::unique_ptr<RobotFollower> robot_;  // only with robot_motion
  FeedOwner image_owner_;
  ImageBacklog backlog_;
  sensor_msgs::ImageConstPtr left_;  // the last one that was not taken, until another one comes
  ros::WallTimer left_timer_;
  FeedOwner camera_info_owner_;
  ros::Time last_now_;
  std::unique_ptr<image_transport::ImageTransport> transport_;  // for other transports than raw
  image_transport::Subscriber transport_subscriber_;
  ros::Subscriber image_subscriber_;  // for the raw transport
  ros::Subscriber camera_info_subscriber_;
  ros::WallTimer diagnostics_timer_;
};

}  // namespace laparoscope_servo::nodelets
