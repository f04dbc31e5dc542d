#include "laparoscope_servo/aesop/kinematics.h"

#include <Eigen/LU>
#include <cmath>
#include <sstream>

#include "laparoscope_servo/validation/error_report.h"

namespace laparoscope_servo::aesop {

namespace {

constexpr double kClosestLever = 0.01;  // m: nearer to O_7 the direction to the insertion point is not determined
constexpr double kConverged = 1e-12;    // m
constexpr double kLargestStep = 0.3;    // rad
constexpr int kMaxIterations = 50;

Eigen::Isometry3d linkTransform(const DhJoint& joint, double position) {
  const double theta = joint.theta + (joint.prismatic ? 0.0 : position);
  const double d = joint.d + (joint.prismatic ? position : 0.0);
  Eigen::Isometry3d t = Eigen::Isometry3d::Identity();
  t.rotate(Eigen::AngleAxisd(theta, Eigen::Vector3d::UnitZ()));
  t.translate(Eigen::Vector3d(joint.a, 0.0, d));
  t.rotate(Eigen::AngleAxisd(joint.alpha, Eigen::Vector3d::UnitX()));
  return t;
}

}  // namespace

Kinematics::Kinematics(const KinematicsConfig& config) : config_(config) {
  validation::throwErrors("kinematics", validate(config));
  for (int k = 0; k < kJoints; ++k) {
    const JointRole role = config.joints[static_cast<std::size_t>(k)].role;
    if (role == JointRole::kDriven) driven_.push_back(k);
    if (role == JointRole::kPassive) passive_.push_back(k);
  }
}

std::array<Eigen::Isometry3d, kJoints + 1> Kinematics::linkFrames(const JointVector& q) const {
  std::array<Eigen::Isometry3d, kJoints + 1> frames;
  frames[0] = Eigen::Isometry3d::Identity();
  for (std::size_t k = 0; k < kJoints; ++k) {
    frames[k + 1] = frames[k] * linkTransform(config_.joints[k], q[static_cast<Eigen::Index>(k)]);
  }
  return frames;
}

Eigen::Isometry3d Kinematics::opticalInEndEffector() const {
  return Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, config_.scope_length));
}

Jacobian Kinematics::jacobian(const JointVector& q) const {
  const auto frames = linkFrames(q);
  const Eigen::Vector3d end = frames[kJoints].translation();
  Jacobian j = Jacobian::Zero();
  for (std::size_t k = 0; k < kJoints; ++k) {
    const Eigen::Vector3d axis = frames[k].linear().col(2);
    const auto column = static_cast<Eigen::Index>(k);
    if (config_.joints[k].prismatic) {
      j.col(column).head<3>() = axis;
    } else {
      j.col(column).head<3>() = axis.cross(end - frames[k].translation());
      j.col(column).tail<3>() = axis;
    }
  }
  return j;
}

double Kinematics::leverArm(const JointVector& q, const Eigen::Vector3d& insertion_point) const {
  const Eigen::Isometry3d base_T_end = endEffector(q);
  return base_T_end.linear().col(2).dot(insertion_point - base_T_end.translation());
}

WristSolution Kinematics::solveWrist(const JointVector& q, const Eigen::Vector3d& insertion_point) const {
  WristSolution solution;
  solution.q = q;
  if (!q.allFinite() || !insertion_point.allFinite()) {
    solution.reason = "joint positions or the insertion point are not finite";
    return solution;
  }
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Eigen::Isometry3d base_T_end = endEffector(solution.q);
    const Eigen::Matrix3d end_R_base = base_T_end.linear().transpose();
    const Eigen::Vector3d p = end_R_base * (insertion_point - base_T_end.translation());
    solution.distance = p.head<2>().norm();
    if (solution.distance < kConverged && p.z() > 0.0) break;
    // A point that is fixed in the base moves in frame 7 with -v - w x p; its x and y have to become zero.
    const Jacobian j = jacobian(solution.q);
    Eigen::Matrix2d slope;
    for (int k = 0; k < 2; ++k) {
      const auto column = j.col(passive_[static_cast<std::size_t>(k)]);
      const Eigen::Vector3d v = end_R_base * column.head<3>();
      const Eigen::Vector3d w = end_R_base * column.tail<3>();
      slope.col(k) = -(v + w.cross(p)).head<2>();
    }
    const Eigen::FullPivLU<Eigen::Matrix2d> lu(slope);
    if (!lu.isInvertible()) {
      solution.reason = "the passive wrist is singular";
      return solution;
    }
    Eigen::Vector2d step = lu.solve(-p.head<2>());
    const double largest = step.lpNorm<Eigen::Infinity>();
    if (largest > kLargestStep) step *= kLargestStep / largest;
    for (int k = 0; k < 2; ++k) solution.q[passive_[static_cast<std::size_t>(k)]] += step[k];
  }
  if (!(solution.distance < 1e-9)) {
    solution.reason = "no position of the passive wrist points the shaft at the insertion point";
  } else if (!(leverArm(solution.q, insertion_point) > kClosestLever)) {
    solution.reason = "the insertion point lies within 1 cm of the end effector or behind it";
  } else {
    for (const int joint : passive_) {
      const DhJoint& limits = config_.joints[static_cast<std::size_t>(joint)];
      if (!(solution.q[joint] >= limits.minimum && solution.q[joint] <= limits.maximum)) {
        std::ostringstream text;
        text << "passive joint " << joint + 1 << " would be at " << solution.q[joint] << " rad, its range is "
             << limits.minimum << " to " << limits.maximum;
        solution.reason = text.str();
      }
    }
  }
  solution.ok = solution.reason.empty();
  return solution;
}

std::string Kinematics::error(const JointVector& q) const {
  for (int k = 0; k < kJoints; ++k) {
    const DhJoint& joint = config_.joints[static_cast<std::size_t>(k)];
    if (q[k] >= joint.minimum && q[k] <= joint.maximum) continue;
    std::ostringstream text;
    text << "joint " << k + 1 << " at " << q[k] << (joint.prismatic ? " m" : " rad") << ", its range is "
         << joint.minimum << " to " << joint.maximum;
    return text.str();
  }
  return "";
}

}  // namespace laparoscope_servo::aesop
