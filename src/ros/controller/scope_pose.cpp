#include "ros/controller/scope_pose.h"

#include <ros/console.h>
#include <tf2/exceptions.h>

#include "ros/common/eigen_messages.h"
#include "ros/controller/controller_conversions.h"

namespace laparoscope_servo {

namespace {

constexpr double kWarningPeriod = 10.0;  // s

TransformGateConfig gateConfig(const ControllerNodeConfig& config) {
  TransformGateConfig gate;
  gate.owner = config.tf_owner;
  gate.parameter = "owners/tf";
  gate.frames = {config.camera, config.insertion_point, config.shaft};
  gate.max_ahead = config.control.safety.max_depth_age;
  return gate;
}

}  // namespace

ScopePose::ScopePose(const ControllerNodeConfig& config)
    : insertion_point_(config.insertion_point),
      camera_(config.camera),
      shaft_(config.shaft),
      transforms_(gateConfig(config)),
      watch_(config.control.safety) {}

servo::DepthInput ScopePose::depth(bool engaged, double steady_now) {
  fault_.clear();
  word_ = transforms_.step(engaged, steady_now);
  if (!word_.complaint.empty()) ROS_WARN_STREAM_THROTTLE(kWarningPeriod, word_.complaint);
  servo::DepthInput depth = lookUp(*transforms_.buffer(), engaged, steady_now);
  if (!word_.problem.empty()) {
    depth.problem = word_.problem;
  } else if (!depth.problem.empty() && !word_.complaint.empty()) {
    depth.problem += "; " + word_.complaint;
  }
  // Poses and d2 are relative to this frame.
  if (word_.changed_frame == insertion_point_) {
    fault_ = "the insertion point is another one";
  } else if (!word_.changed_frame.empty()) {
    fault_ = "tf frame " + word_.changed_frame + " is another one, though it is static";
  }
  return depth;
}

servo::DepthInput ScopePose::lookUp(const tf2::BufferCore& tf, bool engaged, double steady_now) {
  servo::DepthInput depth;
  try {
    const auto transform = tf.lookupTransform(camera_, insertion_point_, ros::Time(0));
    const auto shaft = tf.lookupTransform(camera_, shaft_, ros::Time(0)).transform;
    depth = fromTransforms(transform.transform, shaft);
    if (!depth.problem.empty()) return depth;
    if (transform.header.stamp.isZero()) {
      // d2 changes when the scope is inserted, so a static transform cannot come from the arm.
      depth.problem = "tf from " + camera_ + " to " + insertion_point_ + " is static, expected the robot's";
      return depth;
    }
    return judged(depth, shaft, transform.header.stamp, engaged, steady_now);
  } catch (const tf2::ExtrapolationException&) {  // the exception's own text has times, which change with every step
    depth.problem = "tf from " + camera_ + " to " + insertion_point_ + " has no common time";
  } catch (const tf2::TransformException& error) {
    depth.problem = std::string("depth d2 is unknown: ") + error.what();
  }
  return depth;
}

servo::DepthInput ScopePose::judged(const servo::DepthInput& found, const geometry_msgs::Transform& camera_T_shaft,
                                    const ros::Time& stamp, bool engaged, double steady_now) {
  servo::DepthInput depth = found;
  depth.pose_is_new = stamps_.arrived(stamp, steady_now) != StampWatch::Arrival::kRepeated;
  depth.age = stamps_.age(ros::Time::now(), steady_now);
  if (!depth.insertion_point_T_tip) return depth;
  const servo::PoseWatch::Verdict verdict =
      watch_.judge(stamp.toSec(), steady_now, *depth.insertion_point_T_tip, fromMessage(camera_T_shaft), engaged);
  if (!verdict.problem.empty()) depth.problem = verdict.problem;
  fault_ = verdict.fault;
  return depth;
}

std::optional<Eigen::Quaterniond> ScopePose::shaftFrom(const std::string& frame) const {
  try {
    return fromMessage(transforms_.buffer()->lookupTransform(shaft_, frame, ros::Time(0)).transform.rotation);
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

void ScopePose::clear() {
  transforms_.clear();
  stamps_.clear();
}

void ScopePose::describe(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  if (!word_.complaint.empty()) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, word_.complaint);
  status.add("transforms of others refused", word_.strange);
  status.add("transforms refused as nonsense", word_.refused);
}

}  // namespace laparoscope_servo
