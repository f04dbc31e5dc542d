// The nodelets of all trackers of features: topics, services and diagnostics. A kind adds its name.
#pragma once

#include <laparoscope_servo/SelectFeatures.h>
#include <std_srvs/Trigger.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "nodelets/image_nodelet.h"
#include "nodelets/service_thread.h"
#include "ros/common/image_request.h"
#include "ros/features/feature_parameters.h"
#include "ros/features/feature_session.h"
#include "ros/features/pose_publisher.h"
#include "ros/tracker/feed_statistics.h"
#include "ros/tracker/preview.h"

namespace laparoscope_servo::nodelets {

class FeatureNodelet : public ImageNodelet {
 public:
  ~FeatureNodelet() override;

 protected:
  // `kind`: see ros/features/feature_trackers.h.
  explicit FeatureNodelet(std::string kind) : kind_(std::move(kind)) {}

 private:
  struct Answer {
    bool success = false;
    std::string message;
  };
  using Request = ImageRequest<features::FeatureSelection, Answer>;

  std::vector<std::string> configure() override;
  void start() override;
  void process(const sensor_msgs::ImageConstPtr& message) override;
  void takeCameraInfo(const sensor_msgs::CameraInfo& info) override { session_->setCameraInfo(info); }
  void clockJumpedBack() override { session_->clockJumpedBack(); }
  void notSeen(const sensor_msgs::Image& image, const std::string& why) override;
  void refused(const std::string& error, Refusal cause) override;
  void diagnose(double now, const FeedPublishers& publishers,
                diagnostic_updater::DiagnosticStatusWrapper& status) override;
  void publish(const ProcessedFeatures& processed);
  void publishFeatures(const ProcessedFeatures& processed, const cv::Size& size);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  // In a thread of its own, because it waits for an image.
  bool select(SelectFeatures::Request& request, SelectFeatures::Response& response);

  std::string kind_;
  FeatureInput input_;
  std::unique_ptr<FeatureSession> session_;
  FeedStatistics statistics_;
  features::TrackedFeatures last_;
  std::string selection_error_;
  std::string camera_error_;
  std::string motion_error_;
  Request request_;
  std::unique_ptr<ServiceThread> request_thread_;
  ros::Publisher features_publisher_;
  ros::Publisher overlay_publisher_;
  ros::Publisher preview_publisher_;  // for a screen where no region tracker runs
  Preview preview_;
  ros::Publisher mask_publisher_;         // where the tracker has one
  std::unique_ptr<PosePublisher> poses_;  // where the tracker may have some
  ros::ServiceServer reset_server_;
};

}  // namespace laparoscope_servo::nodelets
