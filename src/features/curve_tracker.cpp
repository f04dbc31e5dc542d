#include "laparoscope_servo/features/curve_tracker.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "laparoscope_servo/image/image_type.h"
#include "laparoscope_servo/validation/error_report.h"

namespace laparoscope_servo::features {

namespace {

constexpr int kVelocitySites = 32;
constexpr double kLeastSurprise = 5.0;  // px
constexpr double kForget = 0.9;         // of the usual jump, each image

const EdgeConfig& checked(const EdgeConfig& config) {
  validation::throwErrors("edges", validate(config));
  return config;
}

}  // namespace

CurveTrackerBase::CurveTrackerBase(const EdgeConfig& config)
    : config_(checked(config)), fit_(config), keeper_(config.state) {
  const std::size_t most = static_cast<std::size_t>(config.max_sites) + 16;
  sites_before_.reserve(most);
  sites_now_.reserve(most);
}

void CurveTrackerBase::checkSelection(const cv::Mat& image, double stamp) const {
  image::checkImage(image, stamp);
}

void CurveTrackerBase::refuse(const EdgeReport& report) {
  std::ostringstream text;
  text.precision(3);
  text << "no such edge in the image: " << reasonText(report.reason) << " (" << report.used << " of " << report.inside
       << " sites in the image agree, expected half of them; expected error " << report.expected_error << " px)";
  throw std::invalid_argument(text.str());
}

bool CurveTrackerBase::accepts(const cv::Mat& image, double stamp) {
  const Reason ended = sequence_.judge(image, stamp);
  if (keeper_.state() == State::kIdle) return false;
  if (ended != Reason::kNone) keeper_.reset(ended);
  return ended == Reason::kNone;
}

void CurveTrackerBase::start(const cv::Mat& image, double stamp) {
  sequence_.begin(image, stamp);
  tracked_stamp_ = stamp;
  usual_jump_ = 0.0;
  stopVelocity();
  if (keeper_.state() != State::kTracking || keeper_.confirmed() == 0) keeper_.select(stamp);
}

Eigen::Matrix3d CurveTrackerBase::drift(double stamp) const {
  Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
  Eigen::Vector2d shift = config_.velocity_damping * (stamp - tracked_stamp_) * velocity_;
  // After a pause nothing is known of the motion.
  if (!(shift.norm() <= config_.range)) shift.setZero();
  result.topRightCorner<2, 1>() = shift;
  return result;
}

void CurveTrackerBase::measureVelocity(const Curve& before, const Curve& now, double stamp) {
  const double passed = stamp - tracked_stamp_;
  tracked_stamp_ = stamp;
  if (!(passed > 0.0)) return;
  before.sites(config_.spacing, std::min(kVelocitySites, config_.max_sites), sites_before_);
  now.sites(config_.spacing, std::min(kVelocitySites, config_.max_sites), sites_now_);
  // By displacements along normals; along a straight line there is none to be seen, and it is held at 0.
  Eigen::Matrix2d normal = Eigen::Matrix2d::Identity();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  auto next = sites_now_.begin();
  for (const Site& site : sites_before_) {
    while (next != sites_now_.end() && next->slot < site.slot) ++next;
    if (next == sites_now_.end() || next->slot != site.slot) continue;
    const Eigen::Vector2d& n = site.normal;
    normal += n * n.transpose();
    right += n * n.dot(next->point - site.point);
  }
  velocity_ = normal.ldlt().solve(right) / passed;
}

double CurveTrackerBase::surprise() const {
  return std::max(kLeastSurprise, 2.0 * usual_jump_);
}

void CurveTrackerBase::noteJump(double jump) {
  usual_jump_ = std::max(jump, kForget * usual_jump_);
}

}  // namespace laparoscope_servo::features
