#include "laparoscope_servo/ros/static_frame_watch.h"

#include <tf2/exceptions.h>

namespace laparoscope_servo::skin {

namespace {

constexpr double kStill = 1e-6;  // m, rad

Eigen::Isometry3d toIsometry(const geometry_msgs::Transform& t) {
  return Eigen::Translation3d(t.translation.x, t.translation.y, t.translation.z) *
         Eigen::Quaterniond(t.rotation.w, t.rotation.x, t.rotation.y, t.rotation.z).normalized();
}

}  // namespace

bool StaticFrameWatch::moved(const tf2::BufferCore& tf, const std::string& frame) {
  std::string parent;
  if (!tf._getParent(frame, ros::Time(0), parent)) return false;
  Eigen::Isometry3d now;
  try {
    const geometry_msgs::TransformStamped transform = tf.lookupTransform(parent, frame, ros::Time(0));
    if (!transform.header.stamp.isZero()) return false;
    now = toIsometry(transform.transform);
  } catch (const tf2::TransformException&) {
    return false;
  }
  const bool moved =
      last_ && (parent != parent_ || !((last_->inverse() * now).matrix() - Eigen::Matrix4d::Identity()).isZero(kStill));
  parent_ = parent;
  last_ = now;
  return moved;
}

}  // namespace laparoscope_servo::skin
