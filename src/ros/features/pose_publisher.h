// Publishes the poses among the features of a tracker: `~pose`, and, where it is asked for, tf.
#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <ros/node_handle.h>
#include <std_msgs/Header.h>
#include <tf2_ros/transform_broadcaster.h>

#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/features/tracked_feature.h"

namespace laparoscope_servo {

// The name of an object's tf frame: the node's name with its namespace, a slash, and the object's id, in which all but
// letters and digits of ASCII become an underscore. Two nodes never give one name, since names of nodes are unique.
std::string poseFrame(const std::string& node, const std::string& id);

// Of a POSE that is TRACKING: the object's frame in that of the image. The covariance is row-major, of x, y, z (m) and
// of rotations (rad) about the fixed axes x, y, z of the image's frame.
geometry_msgs::PoseWithCovarianceStamped poseMessage(const std_msgs::Header& header,
                                                     const features::TrackedFeature& feature);

// The transforms of all POSEs that are TRACKING, each frame once: of two ids that differ only in what poseFrame()
// replaces, the first one has the frame. None where the image has no frame.
std::vector<geometry_msgs::TransformStamped> poseTransforms(const std_msgs::Header& header,
                                                            const features::TrackedFeatures& features,
                                                            const std::string& node);

class PosePublisher {
 public:
  // `node`: the private handle of the tracker's node.
  PosePublisher(ros::NodeHandle& node, bool publish_tf);

  // `~pose`: the first POSE that is TRACKING; nothing while none is.
  void publish(const std_msgs::Header& header, const features::TrackedFeatures& features);

 private:
  std::string node_;
  ros::Publisher publisher_;
  std::optional<tf2_ros::TransformBroadcaster> broadcaster_;
};

}  // namespace laparoscope_servo
