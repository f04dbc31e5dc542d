#include "ros/tracker/robot_motion.h"

#include <tf2/exceptions.h>

#include "ros/common/eigen_messages.h"
#include "ros/common/frame_names.h"

namespace laparoscope_servo {

std::string fixedFrame(const RobotMotionConfig& config, const std::string& name_space) {
  return prefixedFrame(framePrefix(config.frame_prefix, name_space), config.fixed_frame);
}

std::optional<Eigen::Isometry3d> cameraMotion(const tf2::BufferCore& tf, const std::string& fixed_frame,
                                              const std::string& frame, const ros::Time& from, const ros::Time& to,
                                              std::string& why) {
  try {
    const Eigen::Isometry3d fixed_T_from = fromMessage(tf.lookupTransform(fixed_frame, frame, from).transform);
    const Eigen::Isometry3d fixed_T_to = fromMessage(tf.lookupTransform(fixed_frame, frame, to).transform);
    const Eigen::Isometry3d motion = fixed_T_to.inverse() * fixed_T_from;
    if (motion.matrix().allFinite()) return motion;
    why = "the pose of " + frame + " in " + fixed_frame + " is not finite";
  } catch (const tf2::ExtrapolationException&) {  // the exception's own text has times, which change with every image
    why = "tf does not know the pose of " + frame + " in " + fixed_frame + " at the images' stamps";
  } catch (const tf2::TransformException& error) {
    why = error.what();
  }
  return std::nullopt;
}

}  // namespace laparoscope_servo
