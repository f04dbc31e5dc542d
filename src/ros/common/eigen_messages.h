// Conversions between Eigen and geometry messages, by tf2_eigen.
#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Vector3.h>

#include <Eigen/Geometry>

namespace laparoscope_servo {

Eigen::Vector3d fromMessage(const geometry_msgs::Vector3& message);
// Normalised to length 1, since a message's quaternion may be rounded; not finite for length 0.
Eigen::Quaterniond fromMessage(const geometry_msgs::Quaternion& message);
Eigen::Isometry3d fromMessage(const geometry_msgs::Transform& message);

geometry_msgs::Vector3 vectorMessage(const Eigen::Vector3d& vector);
geometry_msgs::Point pointMessage(const Eigen::Vector3d& point);
geometry_msgs::Quaternion rotationMessage(const Eigen::Matrix3d& rotation);
geometry_msgs::Transform transformMessage(const Eigen::Isometry3d& transform);

}  // namespace laparoscope_servo
