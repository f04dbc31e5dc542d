#include "servo/safety/leash.h"

#include <cmath>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/scope/geometry.h"

namespace laparoscope_servo::servo {

namespace {

constexpr double kHalf = 0.5;  // of the way, after which the target is taken anew
// Of what is left to go in any way, on top along the shaft: with both depths wrong by two, 50 starts each, 0.25 are
// needed.
constexpr double kAside = 0.3;
constexpr double kReached = 0.05;  // share of the leash; with less left to go it is not worth taking the target anew
constexpr double kReleased = 0.9;  // share of the leash, below which a target that had wandered is back

const char* const kWays[] = {"sideways", "about the shaft", "along the shaft", "along the shaft, and quickly"};

Eigen::Vector3d rotationOf(const Eigen::Vector4d& displacement) {
  return scope::angularVelocity(scope::Velocity::fromVector(displacement));
}

}  // namespace

void Leash::restart() {
  last_.reset();
  used_ = 0.0;
  words_.clear();
}

bool Leash::isOther(const LeashObservation& image) const {
  if (!last_) return true;
  const TaskError& a = image.error;
  const TaskError& b = last_->error;
  return image.region != last_->region || a.m_star != b.m_star || a.desired_x != b.desired_x ||
         a.desired_y != b.desired_y || a.desired_log_depth != b.desired_log_depth ||
         a.desired_alpha != b.desired_alpha ||
         image.insertion_point_T_tip.has_value() != anchor_.insertion_point_R_shaft.has_value();
}

Leash::Shares Leash::shares(const Eigen::Vector3d& turn, double insertion, double quick) const {
  return {turn.head<2>().norm() / config_.turn, std::abs(turn.z()) / config_.spin,
          std::abs(insertion) / config_.insertion, std::abs(quick) / config_.quick_insertion};
}

void Leash::begin(const LeashObservation& image, const Target& target, const Shares& to_go) {
  anchor_ = target;
  to_go_ = to_go;
  mean_d2_ = target.d2;
  last_ = image;
}

void Leash::observe(const LeashObservation& image) {
  if (!config_.enabled || !std::isfinite(image.time) || !image.to_target.allFinite() || !std::isfinite(image.d2))
    return;
  if (last_ && !(image.time > last_->time)) return;
  Target target;
  target.d2 = image.d2 - image.to_pose[3] + image.to_target[3];
  Eigen::Vector3d turn_to_go = rotationOf(image.to_target);
  if (!image.has_orientation) turn_to_go.z() = 0.0;
  if (image.insertion_point_T_tip) {
    target.insertion_point_R_shaft = image.insertion_point_T_tip->linear() *
                                     geometry::so3Exp(-rotationOf(image.to_pose)) * geometry::so3Exp(turn_to_go);
  }
  const Shares to_go = shares(turn_to_go, image.to_target[3], image.to_target[3]);
  if (isOther(image)) {
    restart();
    begin(image, target, to_go);
    return;
  }
  const double kept = std::exp(-(image.time - last_->time) / config_.quick_time);
  last_ = image;
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  if (target.insertion_point_R_shaft)
    turn = geometry::so3Log(anchor_.insertion_point_R_shaft->transpose() * *target.insertion_point_R_shaft);
  if (target.insertion_point_R_shaft && !image.has_orientation) {
    const Eigen::Vector3d there = anchor_.insertion_point_R_shaft->transpose() * target.insertion_point_R_shaft->col(2);
    turn = geometry::so3Log(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), there).toRotationMatrix());
  }
  const Shares wandered = shares(turn, target.d2 - anchor_.d2, target.d2 - mean_d2_);
  mean_d2_ = target.d2 + kept * (mean_d2_ - target.d2);
  // Along the shaft, depths that are wrong by two err by all that is left to go, beside what the tissue does meanwhile.
  // Sideways and about the shaft they err by less, which mostly lies within the leash.
  Shares most = (config_.approach * to_go_).cwiseMax(1.0);
  const double aside = kAside * to_go_.maxCoeff();
  for (Eigen::Index k = 2; k < 4; ++k) most[k] = 1.0 + config_.approach * (to_go_[k] + aside);
  Eigen::Index furthest = 0;
  used_ = wandered.cwiseQuotient(most).maxCoeff(&furthest);
  if (used_ < (words_.empty() ? 1.0 : kReleased)) {
    words_.clear();
    const double left = to_go_.maxCoeff();
    if (left > kReached && to_go.maxCoeff() < kHalf * left) begin(image, target, to_go);
  } else if (words_.empty()) {
    words_ = std::string("the view has wandered too far ") + kWays[furthest] + ": look at the picture";
  }
}

}  // namespace laparoscope_servo::servo
