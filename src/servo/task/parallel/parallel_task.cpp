#include "servo/task/parallel/parallel_task.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::servo {

namespace {

// s, over which the noise of poses is taken out of the error; the commands tell what the scope does meanwhile.
constexpr double kFilter = 0.2;
constexpr std::size_t kMostWaiting = 32;  // images that wait for their pose: 0.25 s at 120 Hz
constexpr double kMoved = 0.05;     // rad: the scope was turned by that since the announcement, which is wrong then
constexpr double kAgreement = 0.5;  // share of the way that the picture shows; tissue that breathes by 4 mm leaves 0.8
// rad: pan or tilt goes on alone until less of it is left, and begins alone only where more is.
constexpr double kAloneUntil = 0.02, kAloneFrom = 0.04;
// Of a circle: on less of it the scope has hardly left its way from rest, where a line through its poses errs. Measured
// by 100 runs of config/scenarios/parallel.yaml: after half of a circle the normal is up to 0.49 degrees off, after
// this up to 0.37.
constexpr double kLeastShare = 0.75;
constexpr int kStrange = 5;  // images in a row
// The arm stands when its shaft, kStoodFrom and kStoodTo ago [s], pointed to the same direction but for kStood [rad]:
// two and a half times what the noise of poses makes of it (0.2 degrees each), and a quarter of what the circle does.
constexpr double kStoodFrom = 0.35, kStoodTo = 0.15, kStood = 0.004;
constexpr double kMostSettling = 5.0;  // s, many times the delay of an arm

Eigen::Vector3d turnOf(const Eigen::Vector4d& displacement) {
  return scope::angularVelocity(scope::Velocity::fromVector(displacement));
}

}  // namespace

ParallelTask::ParallelTask(const ParallelConfig& config, const Workspace& range, double desired_depth)
    : config_(config), range_(range), desired_depth_(desired_depth) {}

void ParallelTask::restart() {
  poses_.clear();
  waiting_.clear();
  anchor_.reset();
  seen_at_.reset();
  pose_.reset();
  plane_.restart();
  problem_.clear();
  announcement_.clear();
  figures_ = ParallelFigures();
}

void ParallelTask::fail(const std::string& problem) {
  problem_ = problem;
  figures_.stage = ParallelStage::kUnknown;
  figures_.is_known = false;
}

void ParallelTask::engage(double time) {
  problem_.clear();
  const bool is_recent = time - since_ <= config_.keep;
  const bool is_here = pose_ && geometry::angleBetween(pose_->base_T_tip.linear().col(2), announced_from_) <= kMoved;
  if (stage() == ParallelStage::kTurn && is_recent) return;
  if (stage() == ParallelStage::kAnnounced && is_recent && is_here) {
    figures_.stage = ParallelStage::kTurn;
    strange_ = 0;
    return;
  }
  plane_.restart();
  waiting_.clear();
  phase_ = 0.0;
  announcement_.clear();
  figures_ = ParallelFigures();
  figures_.stage = ParallelStage::kCircle;
}

void ParallelTask::leaveCircle() {
  if (stage() == ParallelStage::kCircle || stage() == ParallelStage::kSettles) figures_.stage = ParallelStage::kUnknown;
}

void ParallelTask::move(const ParallelPose& pose, const CommandHistory& commands, double delay) {
  poses_.add(pose.time, pose.base_T_tip);
  pose_ = pose;
  while (!waiting_.empty() && poses_.reaches(waiting_.front().time)) {
    const Waiting image = waiting_.front();
    waiting_.pop_front();
    const std::optional<Eigen::Isometry3d> then = poses_.at(image.time);
    if (!then) continue;
    if (stage() == ParallelStage::kCircle) measure(image, *then);
    if (stage() == ParallelStage::kTurn) compare(image, *then);
  }
  if (stage() == ParallelStage::kSettles) settle();
  if (!figures_.is_known) return;
  const Eigen::Matrix3d& camera_R_shaft = pose.scope.camera_R_shaft;
  const Eigen::Vector3d now =
      camera_R_shaft.transpose() * estimate_.seenFrom(pose.base_T_tip.linear() * camera_R_shaft.transpose());
  if (pose.time > filtered_at_ && pose.time - filtered_at_ < 1.0) {
    const double dt = pose.time - filtered_at_;
    const Eigen::Vector4d gone = commands.displacement(filtered_at_, pose.time, delay);
    const Eigen::Vector3d expected = geometry::so3Exp(-turnOf(gone)) * filtered_;
    filtered_ = (expected + (1.0 - std::exp(-dt / kFilter)) * (now - expected)).normalized();
  } else if (pose.time != filtered_at_) {
    filtered_ = now;
  }
  filtered_at_ = pose.time;
  chooseAxis();
  figures_.normal_in_camera = camera_R_shaft * filtered_;
}

void ParallelTask::see(double time, double anchor, const ViewMotion& motion, bool moves) {
  if (anchor_ && *anchor_ != anchor) restart();
  anchor_ = anchor;
  if (seen_at_ && !(time > *seen_at_)) return;
  seen_at_ = time;
  if (waiting_.size() == kMostWaiting) waiting_.pop_front();
  waiting_.push_back({time, motion, moves});
}

// A circle through where the scope stands: it goes round without a jump, and ends where it began.
scope::Velocity ParallelTask::circle(double period) {
  phase_ += period;
  if (phase_ > config_.turns * config_.period) {
    fail(figures_.views == 0
             ? "the tissue's normal did not become known: poses and pictures did not come for the same time"
             : "the tissue's normal did not become known within parallel/turns circles: its slant shows too little");
    return scope::Velocity();
  }
  const double rate = 2.0 * M_PI / config_.period;
  scope::Velocity velocity;
  velocity.pan = config_.radius * rate * std::cos(rate * phase_);
  velocity.tilt = config_.radius * rate * std::sin(rate * phase_);
  return velocity;
}

void ParallelTask::measure(const Waiting& image, const Eigen::Isometry3d& base_T_shaft) {
  if (!image.moves || !pose_) return;
  PlaneView view;
  view.motion = image.motion;
  view.base_R_camera = base_T_shaft.linear() * pose_->scope.camera_R_shaft.transpose();
  view.camera = base_T_shaft.translation();
  plane_.add(view);
  const PlaneEstimate& estimate = plane_.estimate();
  figures_.views = static_cast<int>(plane_.views());
  figures_.stddev = estimate.is_known ? estimate.stddev : 0.0;
  if (!estimate.is_known || !(estimate.stddev <= config_.stddev) || !(phase_ >= kLeastShare * config_.period)) return;
  if (!(estimate.agreement >= kAgreement)) {
    fail("picture and arm do not tell the same motion of the camera: the tissue moves, or a frame of tf is wrong");
    return;
  }
  estimate_ = estimate;
  settles_from_ = pose_->time;
  figures_.stage = ParallelStage::kSettles;
}

// An arm goes on for its delay: what the turn will do is said of where it stands then.
void ParallelTask::settle() {
  const double now = pose_->time;
  if (now - settles_from_ > kMostSettling) {
    fail("the arm does not come to rest after the circle");
    return;
  }
  if (now - settles_from_ < kStoodFrom) return;
  const std::optional<Eigen::Isometry3d> first = poses_.at(now - kStoodFrom), last = poses_.at(now - kStoodTo);
  if (first && last && geometry::angleBetween(first->linear().col(2), last->linear().col(2)) <= kStood) announce();
}

void ParallelTask::announce() {
  // By the arm's poses, as the range is: what they tell of a turn may differ from it by the factor. The tissue stays as
  // far below the camera.
  const Eigen::Vector3d normal = estimate_.normalOfPoses();
  const double nearer = (estimate_.normal - normal).dot(pose_->base_T_tip.translation());
  const TissuePlane tissue{normal, estimate_.distance - nearer};
  const ParallelPlan plan = planned(tissue, pose_->base_T_tip, pose_->scope, config_, range_);
  if (!plan.problem.empty()) {
    fail(plan.problem);
    return;
  }
  announcement_ = plan.words();
  announced_from_ = pose_->base_T_tip.linear().col(2);
  since_ = pose_->time;
  figures_.stage = ParallelStage::kAnnounced;
  figures_.is_known = true;
  figures_.normal = estimate_.normal;
  figures_.distance = estimate_.distance;
  normal_in_anchor_ = estimate_.normal_in_anchor;
  filtered_at_ = -std::numeric_limits<double>::infinity();
}

// A plane's coordinates go by the inverse of the homography: n at the anchor becomes H^-T n.
void ParallelTask::compare(const Waiting& image, const Eigen::Isometry3d& base_T_shaft) {
  const Eigen::Vector3d seen = (image.motion.h.inverse().transpose() * normal_in_anchor_).normalized();
  const Eigen::Vector3d told = estimate_.seenFrom(base_T_shaft.linear() * pose_->scope.camera_R_shaft.transpose());
  const double angle = geometry::angleBetween(seen.z() < 0.0 ? Eigen::Vector3d(-seen) : seen, told);
  strange_ = angle <= config_.max_change ? 0 : strange_ + 1;
  if (strange_ >= kStrange)
    fail("the tissue's normal is not where it was measured: the tissue has tilted, or is not flat enough");
}

TaskError ParallelTask::errorOf(const Eigen::Vector3d& normal) const {
  return errorTowards(normal, pose_->scope, desired_depth_);
}

void ParallelTask::chooseAxis() {
  const Eigen::Vector3d axis = pose_->scope.camera_R_shaft.transpose() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d left = geometry::so3Log(turnTo(filtered_, axis));
  if (!left.allFinite()) {
    next_ = filtered_;
    return;
  }
  if (turning_ && !(std::abs(left[*turning_]) > kAloneUntil)) turning_.reset();
  const int longer = std::abs(left.x()) > std::abs(left.y()) ? 0 : 1;
  if (!turning_ && std::abs(left[longer]) > kAloneFrom) turning_ = longer;
  next_ = turning_ ? Eigen::Vector3d(geometry::so3Exp(left[*turning_] * Eigen::Vector3d::Unit(*turning_)) * axis)
                   : filtered_;
}

}  // namespace laparoscope_servo::servo
