#include "laparoscope_servo/aesop/calibration_pattern.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::aesop {

namespace {

constexpr int kCorners = 12;           // number of directions round the cone
constexpr double kReached = 0.015;     // rad
constexpr double kProgress = 0.002;    // rad, by which the shaft must come nearer to count as progress
constexpr double kMargin = 0.05;       // rad, beyond the cone
constexpr double kDepthGain = 1.0;     // 1/s
constexpr double kDepthSpeed = 0.005;  // m/s, at most
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

void describe(parameters::Table& table, PatternConfig& c) {
  table.number("pattern_angle", c.angle, {0.02, 0.4}, "rad", "half the opening angle of the cone");
  table.number("pattern_speed", c.speed, {0.02, 0.15}, "rad/s", "of the shaft on its way round");
  table.number("pattern_max_depth_change", c.max_depth_change, {0.001, 0.05}, "m", "beyond it the pattern ends");
  table.number("pattern_patience", c.patience, {0.5, 20}, "s",
               "the pattern ends without progress towards the next direction for this time");
}

std::vector<std::string> validate(const PatternConfig& config) {
  return parameters::errorsOf(config);
}

CalibrationPattern::CalibrationPattern(const PatternConfig& config, const Kinematics& kinematics, const JointVector& q,
                                       const Eigen::Vector3d& insertion_point, double now)
    : config_(config),
      kinematics_(kinematics),
      insertion_point_(insertion_point),
      nearest_(kInfinity),
      nearest_at_(now) {
  const Eigen::Isometry3d base_T_end = kinematics_.endEffector(q);
  start_ = base_T_end.linear().col(2);
  start_lever_ = lever(base_T_end);
  for (int k = 0; k <= kCorners; ++k) {
    const double phase = 2.0 * M_PI * k / kCorners;
    const Eigen::Vector3d on_cone(std::sin(config.angle) * std::cos(phase), std::sin(config.angle) * std::sin(phase),
                                  std::cos(config.angle));
    way_.push_back(base_T_end.linear() * on_cone);
  }
  way_.push_back(start_);
}

double CalibrationPattern::lever(const Eigen::Isometry3d& base_T_end) const {
  return base_T_end.linear().col(2).dot(insertion_point_ - base_T_end.translation());
}

std::string CalibrationPattern::doubt(const Eigen::Isometry3d& base_T_end, const JointMotion& last) const {
  std::ostringstream text;
  const double turned = geometry::angleBetween(base_T_end.linear().col(2), start_);
  const double out = lever(base_T_end) - start_lever_;
  if (last.scale == 0.0) {
    text << last.reason;
  } else if (!(turned <= config_.angle + kMargin)) {
    text << "the shaft has turned by " << turned << " rad, the cone ends at " << config_.angle;
  } else if (!(std::abs(out) <= config_.max_depth_change)) {
    text << "the depth has changed by " << -out << " m, at most " << config_.max_depth_change << " m are expected";
  }
  return text.str();
}

CalibrationPattern::Step CalibrationPattern::step(const JointVector& q, const JointMotion& last, double now) {
  if (ended_) return end_;
  const Eigen::Isometry3d base_T_end = kinematics_.endEffector(q);
  const Eigen::Vector3d axis = base_T_end.linear().col(2);
  end_.problem = doubt(base_T_end, last);
  while (next_ < way_.size() && geometry::angleBetween(axis, way_[next_]) < kReached) {
    ++next_;
    nearest_ = kInfinity;
  }
  end_.done = end_.problem.empty() && next_ == way_.size();
  ended_ = end_.done || !end_.problem.empty();
  if (ended_) return end_;

  const double angle = geometry::angleBetween(axis, way_[next_]);
  if (angle < nearest_ - kProgress) {
    nearest_ = angle;
    nearest_at_ = now;
  } else if (!(now - nearest_at_ <= config_.patience)) {
    end_.problem = "the shaft does not follow" + (last.reason.empty() ? "" : ": " + last.reason);
    ended_ = true;
    return end_;
  }
  // The shaft is z of frame 7, and turns towards (x, y) by pan and tilt in its proportion.
  const Eigen::Vector2d towards = (base_T_end.linear().transpose() * way_[next_]).head<2>().normalized();
  Step step;
  step.velocity.pan = config_.speed * towards.x();
  step.velocity.tilt = -config_.speed * towards.y();
  const double deeper = kDepthGain * (lever(base_T_end) - start_lever_);
  step.velocity.insertion = std::clamp(deeper, -kDepthSpeed, kDepthSpeed);
  return step;
}

}  // namespace laparoscope_servo::aesop
