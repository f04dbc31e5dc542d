#include "laparoscope_servo/servo/pose_watch.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::servo {

namespace {

// s, by which the difference of two stamps may be smaller than that of the poses: the arm's node stamps an answer when
// it reads it, and under load it reads two at once.
constexpr double kStampJitter = 0.05;
constexpr double kLastingJump = 0.5;  // s: a longer jump is no stray message, which correct ones follow at once
constexpr int kJumps = 3;             // jumps in a row, each within kForgotten after the last
constexpr double kForgotten = 10.0;   // s, after a jump
// Tolerances within which the optics count as unchanged since engaging: far more than rounding of a static transform,
// 1e-7 m in single precision, and less than anybody moves a camera by hand.
constexpr double kSameOffset = 1e-4;     // m
constexpr double kSameDirection = 1e-3;  // rad

double angleOf(const Eigen::Matrix3d& rotation) {
  return geometry::so3Log(rotation).norm();
}

}  // namespace

PoseWatch::Verdict PoseWatch::judge(double stamp, double now, const Eigen::Isometry3d& insertion_point_T_tip,
                                    const Eigen::Isometry3d& camera_T_shaft, bool engaged) {
  Verdict verdict;
  verdict.problem = opticsProblem(camera_T_shaft);
  if (!engaged) {
    last_ = Pose{stamp, insertion_point_T_tip};
    optics_ = camera_T_shaft;
    jump_.clear();
    jumps_ = 0;
    return verdict;
  }
  const Eigen::Isometry3d change = optics_.inverse() * camera_T_shaft;
  if (!(change.translation().norm() <= kSameOffset && angleOf(change.linear()) <= kSameDirection)) {
    verdict.fault = verdict.problem = "the camera is placed otherwise on the shaft than at engaging";
    return verdict;
  }
  if (!verdict.problem.empty()) return verdict;
  const std::string found = jump(stamp, insertion_point_T_tip);
  if (found.empty()) last_ = Pose{stamp, insertion_point_T_tip};
  return judgeJump(found, now);
}

std::string PoseWatch::opticsProblem(const Eigen::Isometry3d& camera_T_shaft) const {
  const double offset = camera_T_shaft.translation().norm();
  if (offset <= config_.max_optics_offset) return "";
  std::ostringstream text;
  text.precision(3);
  text << "the camera is " << offset << " m from the shaft's frame, expected at most " << config_.max_optics_offset
       << " m";
  return text.str();
}

std::string PoseWatch::jump(double stamp, const Eigen::Isometry3d& insertion_point_T_tip) const {
  if (!last_) return "";
  const double distance = (insertion_point_T_tip.translation() - last_->insertion_point_T_tip.translation()).norm();
  const double angle = angleOf(last_->insertion_point_T_tip.linear().transpose() * insertion_point_T_tip.linear());
  // In motion no pose is older than max_depth_age, and at rest the arm does not move.
  const double time = std::clamp(stamp - last_->stamp, 0.0, config_.max_depth_age) + kStampJitter;
  if (distance <= config_.max_tip_speed * time && angle <= config_.max_tip_turn * time) return "";
  std::ostringstream text;
  text.precision(2);
  text << "the scope's pose jumped by " << distance << " m and " << angle
       << " rad, more than the arm moves: was it moved by hand, or is it told by two?";
  return text.str();
}

PoseWatch::Verdict PoseWatch::judgeJump(const std::string& found, double now) {
  Verdict verdict;
  if (found.empty()) {
    jump_.clear();
    return verdict;
  }
  if (jump_.empty()) {
    if (now - jump_since_ > kForgotten) jumps_ = 0;
    ++jumps_;
    jump_ = found;
    jump_since_ = now;
  }
  verdict.problem = jump_;
  if (jumps_ >= kJumps || now - jump_since_ > kLastingJump) verdict.fault = jump_;
  return verdict;
}

}  // namespace laparoscope_servo::servo
