#include "laparoscope_servo/aesop/scope_motion.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/robust/largest.h"
#include "laparoscope_servo/scope/insertion_point.h"

namespace laparoscope_servo::aesop {

namespace {

constexpr double kLength = 0.3;             // m, makes lengths comparable with angles
constexpr double kLargestDeviation = 0.02;  // m, of the shaft's line from the insertion point
// rad or m, step of the joint that moves most, to test whether a motion leads towards a singularity. It is short, since
// a long step could end beyond the singularity, where the Jacobian is well conditioned again.
constexpr double kLookAhead = 1e-4;
constexpr double kSingular = 1e-3;    // smallest singular value from which the direction of joint motion is determined
constexpr double kTangential = 1e-6;  // 1/s; a slower decrease of the singular value is ignored

// Columns of the joints that move: driven and passive ones in the order of the arm.
std::vector<int> movingJoints(const Kinematics& kinematics) {
  std::vector<int> joints = kinematics.driven();
  joints.insert(joints.end(), kinematics.passive().begin(), kinematics.passive().end());
  std::sort(joints.begin(), joints.end());
  return joints;
}

geometry::Matrix6d movingJacobian(const Kinematics& kinematics, const JointVector& q) {
  const Jacobian j = kinematics.jacobian(q);
  const std::vector<int> joints = movingJoints(kinematics);
  geometry::Matrix6d m;
  for (int k = 0; k < 6; ++k) m.col(k) = j.col(joints[static_cast<std::size_t>(k)]);
  return m;
}

// Keeps the smallest scale, and its reason.
class Brake {
 public:
  explicit Brake(double stopping_time) : stopping_time_(stopping_time) {}

  // `room`: distance left to the limit; `margin`: distance at which slowing begins at the latest; `speed`: at which the
  // room shrinks. The scaled motion would need at least the stopping time to reach the limit.
  void apply(double room, double margin, double speed, const std::string& what) {
    limit(room / robust::largest(margin, stopping_time_ * speed), what);
  }
  void limit(double scale, const std::string& what) {
    const double bounded = scale > 0.0 ? scale : 0.0;  // NaN is treated as 0, i.e. stop
    if (bounded >= scale_) return;
    scale_ = bounded;
    what_ = what;
  }
  double scale() const { return scale_; }
  std::string reason() const { return what_.empty() ? "" : (scale_ > 0.0 ? "slowed: " : "held: ") + what_; }

 private:
  double stopping_time_;
  double scale_ = 1.0;
  std::string what_;
};

std::string jointReason(int joint, const char* what) {
  return "joint " + std::to_string(joint + 1) + what;
}

void brakeAtJointLimits(const Kinematics& kinematics, const MotionConfig& config, const JointVector& q,
                        const JointVector& velocity, Brake& brake) {
  for (int k = 0; k < kJoints; ++k) {
    const DhJoint& joint = kinematics.config().joints[static_cast<std::size_t>(k)];
    const double margin = joint.prismatic ? config.limit_margin_distance : config.limit_margin_angle;
    const double speed = std::abs(velocity[k]);
    if (velocity[k] > 0.0) brake.apply(joint.maximum - q[k], margin, speed, jointReason(k, " is near its upper limit"));
    if (velocity[k] < 0.0) brake.apply(q[k] - joint.minimum, margin, speed, jointReason(k, " is near its lower limit"));
    if (speed > joint.max_speed) brake.limit(joint.max_speed / speed, jointReason(k, " is at its highest speed"));
  }
}

void brakeAtDepth(const KinematicsConfig& kinematics, const MotionConfig& config, double d2, double insertion,
                  Brake& brake) {
  const double margin = config.limit_margin_distance;
  const double speed = std::abs(insertion);
  if (insertion > 0.0)
    brake.apply(kinematics.depth_maximum - d2, margin, speed, "the scope is near its greatest depth");
  if (insertion < 0.0)
    brake.apply(d2 - kinematics.depth_minimum, margin, speed, "the scope is near its smallest depth");
}

void brakeAtShortLever(const MotionConfig& config, double d1, const scope::Velocity& velocity, Brake& brake) {
  const char* what = "the end effector is near the insertion point";
  const double margin = config.lever_slow - config.lever_stop;
  const bool turns = velocity.pan != 0.0 || velocity.tilt != 0.0;
  if (turns || velocity.insertion > 0.0) {
    brake.apply(d1 - config.lever_stop, margin, std::max(0.0, velocity.insertion), what);
  }
}

// Rate of change of conditioning() when the joints move with `velocity` [1/s].
double conditioningRate(const Kinematics& kinematics, const JointVector& q, const JointVector& velocity, double now) {
  const double fastest = velocity.lpNorm<Eigen::Infinity>();
  if (!(fastest > 0.0)) return 0.0;
  const double dt = kLookAhead / fastest;
  return (conditioning(kinematics, q + dt * velocity) - now) / dt;
}

void brakeAtSingularity(const Kinematics& kinematics, const MotionConfig& config, const JointVector& q,
                        const JointVector& velocity, double now, Brake& brake) {
  const double rate = conditioningRate(kinematics, q, velocity, now);
  if (rate >= -kTangential) return;
  brake.apply(now - config.singular_stop, config.singular_slow - config.singular_stop, -rate,
              "the arm is near a singular position");
}

JointMotion refused(const std::string& reason) {
  JointMotion motion;
  motion.scale = 0.0;
  motion.reason = reason;
  return motion;
}

}  // namespace

double conditioning(const Kinematics& kinematics, const JointVector& q) {
  geometry::Matrix6d j = movingJacobian(kinematics, q);
  j.topRows<3>() /= kLength;
  const std::vector<int> joints = movingJoints(kinematics);
  for (int k = 0; k < 6; ++k) {
    const auto joint = static_cast<std::size_t>(joints[static_cast<std::size_t>(k)]);
    if (kinematics.config().joints[joint].prismatic) j.col(k) *= kLength;
  }
  return Eigen::JacobiSVD<geometry::Matrix6d>(j).singularValues()[5];
}

JointMotion jointMotion(const Kinematics& kinematics, const MotionConfig& config, const JointVector& q,
                        const Eigen::Vector3d& insertion_point, const scope::Velocity& velocity) {
  if (!velocity.isFinite()) return refused("the velocity is not finite");
  if (!q.allFinite()) return refused("the joint positions are not finite");
  if (velocity.isZero()) return JointMotion();
  const Eigen::Isometry3d base_T_end = kinematics.endEffector(q);
  const Eigen::Vector3d p = base_T_end.inverse() * insertion_point;
  if (!(p.head<2>().norm() <= kLargestDeviation)) {
    std::ostringstream text;
    text << "the shaft passes the insertion point at " << p.head<2>().norm() << " m, at most " << kLargestDeviation
         << " m are accepted";
    return refused(text.str());
  }
  const double well = conditioning(kinematics, q);
  if (!(well > kSingular)) return refused("the arm is in a singular position");

  const double d1 = p.z();
  const Eigen::Matrix3d base_R_end = base_T_end.linear();
  geometry::Vector6d twist = scope::endEffectorTwist(velocity, d1);
  twist.head<3>() = base_R_end * twist.head<3>().eval();
  twist.tail<3>() = base_R_end * twist.tail<3>().eval();
  const geometry::Vector6d solution = movingJacobian(kinematics, q).partialPivLu().solve(twist);

  if (!solution.allFinite()) return refused("the joint velocities are not finite");
  JointMotion motion;
  const std::vector<int> joints = movingJoints(kinematics);
  for (int k = 0; k < 6; ++k) motion.velocity[joints[static_cast<std::size_t>(k)]] = solution[k];
  Brake brake(config.stopping_time);
  brakeAtJointLimits(kinematics, config, q, motion.velocity, brake);
  brakeAtDepth(kinematics.config(), config, kinematics.config().scope_length - d1, velocity.insertion, brake);
  brakeAtShortLever(config, d1, velocity, brake);
  brakeAtSingularity(kinematics, config, q, motion.velocity, well, brake);
  motion.scale = brake.scale();
  motion.reason = brake.reason();
  motion.velocity *= motion.scale;
  return motion;
}

scope::Velocity scopeVelocity(const Kinematics& kinematics, const JointVector& q, const JointVector& qdot) {
  const geometry::Vector6d twist = kinematics.jacobian(q) * qdot;
  const Eigen::Matrix3d end_R_base = kinematics.endEffector(q).linear().transpose();
  const Eigen::Vector3d v = end_R_base * twist.head<3>();
  const Eigen::Vector3d w = end_R_base * twist.tail<3>();
  return {w.y(), w.x(), w.z(), v.z()};
}

}  // namespace laparoscope_servo::aesop
