// The nodelet laparoscope_servo/Tracker: wires topics, services and parameters to TrackerSession.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <image_transport/image_transport.h>
#include <laparoscope_servo/CheckRoi.h>
#include <laparoscope_servo/FreezeImage.h>
#include <laparoscope_servo/ListViews.h>
#include <laparoscope_servo/SelectRoi.h>
#include <laparoscope_servo/StoredView.h>
#include <nodelet/nodelet.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_srvs/Trigger.h>

#include <memory>
#include <optional>
#include <string>

#include "ros/common/owned_transforms.h"
#include "ros/common/reconfigure_server.h"
#include "ros/tracker/feed_owner.h"
#include "ros/tracker/image_backlog.h"
#include "ros/tracker/preview.h"
#include "ros/tracker/region_desk.h"
#include "ros/tracker/tracker_diagnostics.h"
#include "ros/tracker/tracker_request.h"
#include "ros/tracker/tracker_session.h"
#include "ros/tracker/tracker_state_report.h"
#include "ros/tracker/view_library.h"

namespace laparoscope_servo::nodelets {

class Tracker : public nodelet::Nodelet {
 public:
  ~Tracker() override;

 private:
  void onInit() override;
  void start(const TrackerParameters& parameters);
  void standAside(const std::string& why);
  void followRobot(const RobotMotionConfig& config);

  // The functions below run in the nodelet's own single-threaded queue.
  void subscribeImages();
  void imageCallback(const sensor_msgs::ImageConstPtr& message);
  // For the raw transport, with which the sender of an image is known.
  void rawImageCallback(const ros::MessageEvent<const sensor_msgs::Image>& event);
  void cameraInfoCallback(const ros::MessageEvent<const sensor_msgs::CameraInfo>& event);
  void watchClock();
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  // In a separate queue and thread, because it waits for an image.
  bool selectRoi(SelectRoi::Request& request, SelectRoi::Response& response);
  bool checkRoi(CheckRoi::Request& request, CheckRoi::Response& response);
  bool freezeImage(FreezeImage::Request& request, FreezeImage::Response& response);
  bool selectFrozenRoi(CheckRoi::Request& request, CheckRoi::Response& response);
  // In another queue and thread: comparing views takes seconds, for which no selection should wait.
  bool storeView(StoredView::Request& request, StoredView::Response& response);
  bool recallView(StoredView::Request& request, StoredView::Response& response);
  bool listViews(ListViews::Request& request, ListViews::Response& response);
  TrackerRequest::Answer ask(const TrackerRequest::Question& question);

  void process(const sensor_msgs::ImageConstPtr& message);
  void publish(const Processed& processed);
  void publishState(const std::optional<TrackerState>& state);
  void refuse(const std::string& error, Refusal cause = Refusal::kData);

  std::unique_ptr<OwnedTransforms> transforms_;  // only with robot_motion
  std::unique_ptr<TrackerSession> session_;
  TrackerParameters changed_;  // buffer for live_.take()
  std::unique_ptr<TrackerDiagnostics> statistics_;
  std::unique_ptr<diagnostic_updater::Updater> diagnostics_;
  std::string why_aside_;
  TrackerStateReport state_report_;
  Preview preview_;

  TrackerRequest request_;
  std::unique_ptr<RegionDesk> desk_;  // used by the thread of the requests
  ros::CallbackQueue request_queue_;
  std::unique_ptr<ros::AsyncSpinner> request_spinner_;
  std::unique_ptr<ViewLibrary> views_;  // used by the thread of the views
  ros::CallbackQueue view_queue_;
  std::unique_ptr<ros::AsyncSpinner> view_spinner_;

  FeedOwner image_owner_;
  ImageBacklog backlog_;
  FeedOwner camera_info_owner_;
  ros::Time last_now_;
  std::unique_ptr<image_transport::ImageTransport> transport_;  // for other transports than raw
  image_transport::Subscriber transport_subscriber_;
  ros::Subscriber image_subscriber_;  // for the raw transport
  ros::Subscriber camera_info_subscriber_;
  ros::Publisher homography_publisher_;
  ros::Publisher task_error_publisher_;
  ros::Publisher areas_publisher_;
  ros::Publisher roi_publisher_;
  ros::Publisher mask_publisher_;
  ros::Publisher overlay_publisher_;
  ros::Publisher preview_publisher_;
  ros::Publisher state_publisher_;
  ros::ServiceServer select_server_;
  ros::ServiceServer check_server_;
  ros::ServiceServer freeze_server_;
  ros::ServiceServer select_frozen_server_;
  ros::ServiceServer list_server_;
  ros::ServiceServer store_server_;
  ros::ServiceServer recall_server_;
  ros::ServiceServer reset_server_;
  ros::WallTimer diagnostics_timer_;
  ros::WallTimer state_timer_;
  std::unique_ptr<LiveParameters<TrackerParameters>> live_;
};

}  // namespace laparoscope_servo::nodelets
