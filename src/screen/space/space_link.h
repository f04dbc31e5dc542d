// What the nodes say that is drawn in space. Thread-safe; none of its functions waits for anybody.
#pragma once

#include <laparoscope_servo/CalibrationState.h>
#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "screen/fact_keeper.h"
#include "screen/features/feature_link.h"
#include "screen/newest_call.h"
#include "screen/space/space_shapes.h"

namespace laparoscope_servo::screen {

// Of the controller, which keeps them while it runs.
struct ControllerBounds {
  ScopeBounds range;
  double desired_depth = 0.0;  // m, from the camera to the tissue: believed, not measured
  double prior_stddev = 0.0;   // m, of an insertion point that is not calibrated
};

class SpaceLink {
 public:
  // `node`: of the cart's namespace; its callback queue is called by another thread.
  SpaceLink(const ros::NodeHandle& node, const std::string& camera_info);
  ~SpaceLink() { features_->close(); }
  SpaceLink(const SpaceLink&) = delete;
  SpaceLink& operator=(const SpaceLink&) = delete;

  // With the newest picture; to be called when something is drawn, for only then a picture is converted.
  Facts facts(double now);
  sensor_msgs::CameraInfoConstPtr cameraInfo() const;
  CalibrationStateConstPtr calibration() const;
  // Empty until the controller's parameters are there.
  std::optional<ControllerBounds> bounds() const;
  // Asks for them, in a thread of its own.
  void askForBounds();
  // Looks for trackers of features that are new, in a thread of its own.
  void findFeatures();

 private:
  ros::NodeHandle node_;
  FactKeeper keeper_;
  mutable std::mutex mutex_;
  sensor_msgs::ImageConstPtr preview_;  // not given to the keeper yet
  double preview_at_ = kNever;
  sensor_msgs::CameraInfoConstPtr camera_info_;
  CalibrationStateConstPtr calibration_;
  std::optional<ControllerBounds> bounds_;
  NewestCall calls_;
  std::shared_ptr<FeatureLink> features_;  // shared with the thread that looks for new ones
  NewestCall feature_calls_;
  // Last, for what they call has to be there.
  ros::Subscriber preview_subscriber_, homography_subscriber_, areas_subscriber_, state_subscriber_;
  ros::Subscriber camera_info_subscriber_, calibration_subscriber_;
};

}  // namespace laparoscope_servo::screen
