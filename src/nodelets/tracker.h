// The nodelet laparoscope_servo/Tracker: wires topics, services and parameters to TrackerSession.
#pragma once

#include <laparoscope_servo/CheckRoi.h>
#include <laparoscope_servo/FreezeImage.h>
#include <laparoscope_servo/ListViews.h>
#include <laparoscope_servo/SelectRoi.h>
#include <laparoscope_servo/StoredView.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_srvs/Trigger.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nodelets/image_nodelet.h"
#include "nodelets/service_thread.h"
#include "ros/common/reconfigure_server.h"
#include "ros/tracker/mask_input.h"
#include "ros/tracker/preview.h"
#include "ros/tracker/region_desk.h"
#include "ros/tracker/tracker_diagnostics.h"
#include "ros/tracker/tracker_request.h"
#include "ros/tracker/tracker_session.h"
#include "ros/tracker/tracker_state_report.h"
#include "ros/tracker/view_library.h"

namespace laparoscope_servo::nodelets {

class Tracker : public ImageNodelet {
 public:
  ~Tracker() override;

 private:
  std::vector<std::string> configure() override;
  void start() override;
  void notStarted(const std::string& why) override;
  void followMasks(MaskInputConfig config);

  // The functions below run in the nodelet's own single-threaded queue.
  void process(const sensor_msgs::ImageConstPtr& message) override;
  void takeCameraInfo(const sensor_msgs::CameraInfo& info) override { session_->setCameraInfo(info); }
  void clockJumpedBack() override;
  void takeMask(const ros::MessageEvent<const sensor_msgs::Image>& event);
  void notSeen(const sensor_msgs::Image& image, const std::string& why) override;
  void refused(const std::string& error, Refusal cause) override;
  void diagnose(double now, const FeedPublishers& publishers,
                diagnostic_updater::DiagnosticStatusWrapper& status) override;
  void publish(const Processed& processed);
  void publishState(const std::optional<TrackerState>& state);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
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
  TrackerRequest::Answer askSnapshot();  // throws std::runtime_error if no image comes
  // The picture with this stamp in which a region is drawn: the frozen one, or the one in which the present region was
  // selected. Throws std::invalid_argument if it is neither. `now`: answer of askSnapshot.
  std::shared_ptr<const Snapshot> pictureOf(const ros::Time& stamp, const TrackerRequest::Answer& now) const;

  std::unique_ptr<MaskInput> masks_;  // only with external_mask
  ros::Subscriber mask_subscriber_;
  std::unique_ptr<TrackerSession> session_;
  TrackerParameters parameters_;  // as read, then buffer for live_.take()
  std::unique_ptr<TrackerDiagnostics> statistics_;
  TrackerStateReport state_report_;
  Preview preview_;

  TrackerRequest request_;
  std::unique_ptr<RegionDesk> desk_;  // used by the thread of the requests
  std::unique_ptr<ServiceThread> request_thread_;
  std::unique_ptr<ViewLibrary> views_;  // used by the thread of the views
  std::unique_ptr<ServiceThread> view_thread_;

  ros::Publisher homography_publisher_;
  ros::Publisher task_error_publisher_;
  ros::Publisher areas_publisher_;
  ros::Publisher roi_publisher_;
  ros::Publisher mask_publisher_;
  ros::Publisher overlay_publisher_;
  ros::Publisher preview_publisher_;
  ros::Publisher state_publisher_;
  ros::ServiceServer reset_server_;
  ros::WallTimer state_timer_;
  std::unique_ptr<LiveParameters<TrackerParameters>> live_;
};

}  // namespace laparoscope_servo::nodelets
