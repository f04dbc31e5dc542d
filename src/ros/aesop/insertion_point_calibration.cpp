#include "ros/aesop/insertion_point_calibration.h"

#include <sstream>
#include <stdexcept>

#include "ros/aesop/insertion_point_file.h"

namespace laparoscope_servo {

namespace {

using aesop::OperatingMode;
using Method = CalibrationMethod;
using Stage = CalibrationStage;

std::string stateText(const aesop::OperatingState& state) {
  return std::string("the arm is ") + name(state.mode) + (state.reason.empty() ? "" : ", " + state.reason);
}

}  // namespace

const char* name(CalibrationMethod method) {
  return method == Method::kHand ? "HAND" : "PATTERN";
}

std::string InsertionPointCalibration::refusal(Method method, double now) const {
  const aesop::Link& link = driver_.session().link();
  const aesop::OperatingState state = driver_.state(now);
  if (stage_ == Stage::kCollecting || stage_ == Stage::kStopping)
    return "a calibration is under way; finish or cancel it";
  if (!link.isUp() || !link.status()) return "not connected: " + link.reason();
  if (!state.is_homed) return "the arm is not homed: its joint positions mean nothing";
  if (method == Method::kHand) {
    return state.mode == OperatingMode::kDisabled ? "" : stateText(state) + "; by hand it has to be DISABLED";
  }
  if (!parameters_.pattern_allowed)
    return "calibration/pattern_allowed is false: no dead-man switch is asked; calibrate.launch sets it";
  if (!driver_.session().isEnabled()) return stateText(state) + "; for the pattern it has to be ENABLED";
  if (state.is_busy || !driver_.guard().velocity(now).isZero())
    return "the arm moves; for the pattern it has to be at rest";
  return "";
}

std::string InsertionPointCalibration::start(Method method, double now) {
  const std::string why_not = refusal(method, now);
  if (!why_not.empty()) return why_not;
  fitter_ = servo::InsertionPointFitter(parameters_.fit);
  poses_.clear();
  pending_.reset();
  seen_ = driver_.session().link().statistics().received;
  if (method == Method::kPattern) {
    pattern_.emplace(parameters_.pattern, driver_.kinematics(), driver_.session().link().status()->position,
                     driver_.insertionPoint(), now);
  }
  method_ = method;
  stage_ = Stage::kCollecting;
  return "";
}

std::string InsertionPointCalibration::cancel(double now) {
  if (stage_ != Stage::kCollecting && stage_ != Stage::kStopping) return "no calibration is under way";
  fail("cancelled", now);
  return "";
}

std::string InsertionPointCalibration::finish(double) {
  if (stage_ != Stage::kCollecting || method_ != Method::kHand) {
    return stage_ == Stage::kCollecting ? "the pattern ends by itself; cancel it, or wait"
                                        : "no calibration is under way";
  }
  return conclude();
}

std::string InsertionPointCalibration::missing() const {
  std::string text;
  for (const std::string& problem : fitter_.problems(driver_.kinematics().config().scope_length)) {
    text += (text.empty() ? "" : "; ") + problem;
  }
  return text;
}

// Ends the calibration; returns why not, or an empty text.
std::string InsertionPointCalibration::conclude() {
  const std::string problems = missing();
  if (!problems.empty()) return problems;
  const servo::InsertionPointFit& fit = fitter_.fit();
  CalibratedInsertionPoint result;
  result.point = fit.point;
  result.covariance = fit.covariance;
  result.stddev = fit.stddev;
  result.residual = fit.residual;
  result.cone = fit.cone;
  result.method = name(*method_);
  result.date = utcDate();
  for (const std::size_t number : fitter_.kept()) result.poses.push_back(poses_[number]);
  try {
    if (!parameters_.file.empty()) saveInsertionPoint(parameters_.file, result);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  pending_ = fit.point;
  stage_ = Stage::kDone;
  std::ostringstream text;
  text.precision(4);
  text << "insertion point at (" << fit.point.x() << ", " << fit.point.y() << ", " << fit.point.z() << ") m, "
       << (fit.point - driver_.insertionPoint()).norm() << " m from the one before; standard deviation " << fit.stddev
       << " m, residual " << fit.residual << " m, " << fit.poses << " poses; "
       << (parameters_.file.empty() ? "not saved: calibration/file is empty" : "saved in " + parameters_.file);
  message_ = text.str();
  return "";
}

std::string InsertionPointCalibration::message() const {
  if (stage_ == Stage::kStopping) return "the pattern is done, the arm is being disabled";
  if (stage_ != Stage::kCollecting) return message_;
  const std::string problems = missing();
  if (!problems.empty()) return problems;
  return method_ == Method::kHand ? "enough; finish, or go on" : "enough; the pattern goes on to its end";
}

// Returns why poses are not valid any more, or an empty text.
std::string InsertionPointCalibration::lostGround(double now) const {
  const aesop::Link& link = driver_.session().link();
  if (!link.isUp() || !link.status()) return "not connected: " + link.reason();
  const aesop::OperatingState state = driver_.state(now);
  const bool as_expected =
      method_ == Method::kHand ? state.mode == OperatingMode::kDisabled : driver_.session().isEnabled();
  return as_expected ? "" : stateText(state);
}

bool InsertionPointCalibration::step(double stamp_now, double now) {
  const aesop::Link& link = driver_.session().link();
  if (stage_ == Stage::kCollecting) {
    const std::string lost = lostGround(now);
    if (!lost.empty()) fail(lost, now);
  }
  if (stage_ == Stage::kCollecting && link.statistics().received != seen_) {
    seen_ = link.statistics().received;
    collect(*link.status());
    if (pattern_) drive(*link.status(), stamp_now, now);
  }
  // Checked and saved at rest, since the disk may be slow.
  if (stage_ == Stage::kStopping && !driver_.session().isEnabled() && !driver_.state(now).is_busy) {
    const std::string problem = conclude();
    if (!problem.empty()) fail(problem, now);
  }
  if (!pending_ || !driver_.setInsertionPoint(*pending_).empty()) return false;
  pending_.reset();
  return true;
}

void InsertionPointCalibration::collect(const aesop::Status& status) {
  const Eigen::Isometry3d base_T_end = driver_.kinematics().endEffector(status.position);
  if (fitter_.add({base_T_end.translation(), base_T_end.linear().col(2)})) poses_.push_back(status.position);
}

void InsertionPointCalibration::drive(const aesop::Status& status, double stamp_now, double now) {
  const aesop::CalibrationPattern::Step step = pattern_->step(status.position, driver_.lastMotion(), now);
  if (!step.problem.empty()) return fail(step.problem, now);
  if (step.done) {
    stopArm(now);
    stage_ = Stage::kStopping;
    return;
  }
  const std::string refused = driver_.command(step.velocity, stamp_now, stamp_now, now);
  if (!refused.empty()) fail("the pattern's command was refused: " + refused, now);
}

void InsertionPointCalibration::otherCommand(const scope::Velocity& velocity, double now) {
  if (!velocity.isZero()) fail("somebody else has sent a command", now);
}

void InsertionPointCalibration::stopArm(double now) {
  if (!pattern_) return;
  pattern_.reset();
  const OperatingMode mode = driver_.state(now).mode;
  // A fault keeps its reason, and a DISABLED arm is at rest.
  if (mode == OperatingMode::kEnabled || mode == OperatingMode::kPaused) driver_.disable(now);
}

void InsertionPointCalibration::fail(const std::string& reason, double now) {
  stopArm(now);
  stage_ = Stage::kFailed;
  message_ = reason + "; the insertion point stays the one before";
}

}  // namespace laparoscope_servo
