// The node `scope_markers`: draws the arm, the scope, its field of view and the insertion point in rviz, from tf; in
// the task POSITION its target, too.
//
// Subscribes: camera_info, homography, controller/state, tf. Publishes: ~markers (visualization_msgs/MarkerArray), ten
// times a second.
#pragma once

#include <laparoscope_servo/ControllerState.h>
#include <laparoscope_servo/Homography.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/parameters/table.h"
#include "ros/simulation/position_target.h"

namespace laparoscope_servo {

struct ScopeMarkersConfig {
  std::string frame_prefix = "auto";                 // prefix of all frames, as for the aesop node
  std::string camera_frame = "laparoscope_optical";  // without the prefix
  std::string insertion_point = "insertion_point";   // without the prefix
  double view_depth = 0.08;                          // m, > 0: depth to which the field of view is drawn
  double scope_radius = 0.005;                       // m, > 0
};

// Adds the rows of the private parameters.
void describe(parameters::Table& table, ScopeMarkersConfig& config);
std::vector<std::string> validate(const ScopeMarkersConfig& config);

class ScopeMarkers {
 public:
  ScopeMarkers(ros::NodeHandle node, ros::NodeHandle private_node, const ScopeMarkersConfig& config);

 private:
  void takeCameraInfo(const sensor_msgs::CameraInfo& info);
  void publish();
  void addArm(visualization_msgs::MarkerArray& array) const;
  void addScope(visualization_msgs::MarkerArray& array) const;
  void addInsertionPoint(visualization_msgs::MarkerArray& array) const;
  void addTarget(visualization_msgs::MarkerArray& array) const;
  // Origin of a frame in the base; empty while tf does not know it.
  std::optional<Eigen::Vector3d> origin(const std::string& frame) const;

  ScopeMarkersConfig config_;
  tf2_ros::Buffer tf_;
  tf2_ros::TransformListener tf_listener_;
  std::optional<geometry::PinholeCamera> camera_;  // of the last camera_info, if it can be used
  cv::Size image_size_;                            // px
  PositionTarget target_;
  bool has_target_ = false;  // the task is POSITION
  ros::Publisher publisher_;
  ros::Subscriber camera_info_subscriber_, homography_subscriber_, state_subscriber_;
  ros::WallTimer timer_;
};

}  // namespace laparoscope_servo
