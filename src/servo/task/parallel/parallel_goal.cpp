#include "servo/task/parallel/parallel_goal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::servo {

namespace {

constexpr double kDegree = M_PI / 180.0;

Eigen::Vector3d opticalAxis(const scope::Geometry& scope) {
  return scope.camera_R_shaft.transpose() * Eigen::Vector3d::UnitZ();
}

}  // namespace

// With oblique optics the axis is not the shaft: each step goes by the part of the turn that pan and tilt can do.
Eigen::Matrix3d turnTo(const Eigen::Vector3d& direction, const Eigen::Vector3d& axis) {
  constexpr int kMostSteps = 30;
  constexpr double kReached = 1e-12;  // rad
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::Vector3d there = turn * axis;
    const double angle = geometry::angleBetween(there, direction);
    if (angle < kReached) return turn;
    const Eigen::Vector3d about = there.cross(direction);
    if (!(about.norm() > 0.0)) break;
    // In the axes that the shaft has by then, a rotation about the optical axis is free: it takes the spin out.
    Eigen::Vector3d by = turn.transpose() * (angle / about.norm() * about);
    by -= by.z() / axis.z() * axis;
    turn = turn * geometry::so3Exp(by);
  }
  return Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
}

TaskError errorTowards(const Eigen::Vector3d& normal_in_shaft, const scope::Geometry& scope, double desired_depth) {
  const Eigen::Vector3d axis = opticalAxis(scope), lever(0.0, 0.0, scope.d2);
  const Eigen::Vector3d point = turnTo(normal_in_shaft, axis) * (desired_depth * axis + lever);  // from O_A
  const Eigen::Vector3d seen = scope.camera_R_shaft * (point - lever);
  TaskError error;
  const bool is_before = seen.z() > 0.0;
  const double none = std::numeric_limits<double>::quiet_NaN();
  error.x = is_before ? seen.x() / seen.z() : none;
  error.y = is_before ? seen.y() / seen.z() : none;
  error.log_depth = is_before ? std::log(seen.z() / desired_depth) : none;
  return error;
}

std::string ParallelPlan::words() const {
  const auto millimetres = [](double metres) { return std::lround(1e3 * metres); };
  std::ostringstream text;
  text << "ready to turn by " << std::lround(turn / kDegree) << " degrees: the view goes " << millimetres(way)
       << " mm over the tissue, which comes from " << millimetres(distance) << " to " << millimetres(remaining)
       << " mm before the lens; engage to turn";
  return text.str();
}

ParallelPlan planned(const TissuePlane& tissue, const Eigen::Isometry3d& base_T_tip, const scope::Geometry& scope,
                     const ParallelConfig& config, const Workspace& range) {
  const Eigen::Vector3d axis = opticalAxis(scope);
  const Eigen::Matrix3d now = base_T_tip.linear();
  const Eigen::Matrix3d goal = now * turnTo(now.transpose() * tissue.normal, axis);
  // Where the optical axis of a pose meets the tissue, and how far from the camera.
  const auto depthOf = [&](const Eigen::Matrix3d& r) {
    return (tissue.distance - tissue.normal.dot(r.col(2)) * scope.d2) / tissue.normal.dot(r * axis);
  };
  const auto meets = [&](const Eigen::Matrix3d& r) -> Eigen::Vector3d {
    return r.col(2) * scope.d2 + depthOf(r) * (r * axis);
  };
  ParallelPlan plan;
  plan.turn = geometry::angleBetween(now * axis, tissue.normal);
  plan.distance = depthOf(now);
  plan.remaining = depthOf(goal);
  plan.way = (meets(goal) - meets(now)).norm();
  const Eigen::Vector3d into = Eigen::Vector3d(range.axis[0], range.axis[1], range.axis[2]);
  if (!(plan.turn <= config.max_turn)) {
    plan.problem = "the tissue is slanted by more than parallel/max_turn";
  } else if (!(geometry::angleBetween(goal.col(2), into) <= range.cone)) {
    plan.problem = "the tissue's normal is outside of the workspace: the scope would leave the cone range/cone";
  } else if (!(plan.remaining >= config.min_distance) || !(plan.distance >= config.min_distance)) {
    plan.problem = "the lens would come nearer to the tissue than parallel/min_distance: draw the scope out first";
  } else if (!std::isfinite(plan.way)) {
    plan.problem = "where the view would be led is not known";
  }
  return plan;
}

}  // namespace laparoscope_servo::servo
