#include "ros/tracker/robot_motion.h"

#include <tf2/exceptions.h>

#include "ros/common/clocks.h"
#include "ros/common/eigen_messages.h"
#include "ros/common/frame_names.h"
#include "ros/common/parameter_names.h"

namespace laparoscope_servo {

namespace {

constexpr double kAhead = 1.0;  // s, by which tf may be ahead of this machine's clock

}  // namespace

void describe(parameters::Table& table, RobotMotionConfig& config) {
  table.flag("enabled", config.enabled, "the motion of the robot is used; not in track_bag");
  describeFrame(table, "fixed_frame", config.fixed_frame, "frame in which the tissue is at rest");
  table.text("frame_prefix", config.frame_prefix,
             "text in front of fixed_frame, unless that has a slash; auto: the namespace, nothing in the root");
  table.text("owner", config.owner, "whose tf is accepted; empty: the first publisher of a frame")
      .accepting("the name of a node, e.g. aesop or /aesop, or nothing",
                 [](const std::string& name) { return name.empty() || isNodeName(name); });
  table.number("depth", config.depth, {0.005, 1}, "m", "of the tissue in front of the camera");
}

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

RobotFollower::RobotFollower(const RobotMotionConfig& config, const ros::NodeHandle& node)
    : fixed_frame_(fixedFrame(config, node.getNamespace())) {
  TransformGateConfig gate;
  if (!config.owner.empty()) gate.owner = node.resolveName(config.owner, false);
  gate.parameter = "robot_motion/owner";
  gate.frames = {fixed_frame_};
  gate.max_ahead = kAhead;
  transforms_ = std::make_unique<OwnedTransforms>(gate);
}

std::optional<Eigen::Isometry3d> RobotFollower::motion(const std::string& frame, const ros::Time& from,
                                                       const ros::Time& to, std::string& why) {
  transforms_->use(frame);
  const OwnedTransforms::Word word = transforms_->step(false, steadyNow());
  complaint_ = word.complaint;
  why = word.problem;
  if (!why.empty()) return std::nullopt;
  const auto motion = cameraMotion(*transforms_->buffer(), fixed_frame_, frame, from, to, why);
  if (!motion && !word.complaint.empty()) why += "; " + word.complaint;
  return motion;
}

}  // namespace laparoscope_servo
