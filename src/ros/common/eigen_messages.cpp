#include "ros/common/eigen_messages.h"

#include <tf2_eigen/tf2_eigen.h>

namespace laparoscope_servo {

Eigen::Vector3d fromMessage(const geometry_msgs::Vector3& message) {
  Eigen::Vector3d vector;
  tf2::fromMsg(message, vector);
  return vector;
}

Eigen::Quaterniond fromMessage(const geometry_msgs::Quaternion& message) {
  const Eigen::Vector4d elements(message.x, message.y, message.z, message.w);
  return Eigen::Quaterniond(Eigen::Vector4d(elements / elements.norm()));
}

Eigen::Isometry3d fromMessage(const geometry_msgs::Transform& message) {
  // Not tf2::transformToEigen, which does not normalise the quaternion: one of another length would also scale.
  return Eigen::Translation3d(fromMessage(message.translation)) * fromMessage(message.rotation);
}

geometry_msgs::Vector3 vectorMessage(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  return tf2::toMsg(vector, message);
}

geometry_msgs::Point pointMessage(const Eigen::Vector3d& point) {
  return tf2::toMsg(point);
}

geometry_msgs::Quaternion rotationMessage(const Eigen::Matrix3d& rotation) {
  return tf2::toMsg(Eigen::Quaterniond(rotation));
}

geometry_msgs::Transform transformMessage(const Eigen::Isometry3d& transform) {
  return tf2::eigenToTransform(transform).transform;
}

}  // namespace laparoscope_servo
