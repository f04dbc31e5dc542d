// From task errors to velocities of the scope: law, predictor, target motion, hysteresis band, limits, dead zone.
//
// The task error of an image is rolled forward to the time when the command that is given now will be executed: by what
// the robot has been told and not done yet, and by the target's own motion. The law sees that error. No safety here:
// see controller.h.
#pragma once

#include <limits>
#include <optional>

#include "laparoscope_servo/servo/controller_config.h"
#include "servo/law/control_law.h"
#include "servo/law/feature_law.h"
#include "servo/law/paper_law.h"
#include "servo/prediction/breathing.h"
#include "servo/prediction/command_history.h"
#include "servo/prediction/delay_estimator.h"
#include "servo/prediction/target_motion.h"
#include "servo/shaping/hysteresis_band.h"
#include "servo/shaping/oscillation_guard.h"
#include "servo/shaping/slew_limiter.h"

namespace laparoscope_servo::servo {

struct ServoInput {
  double time = 0.0;        // s, of the command
  double image_time = 0.0;  // s, of the exposure, on the same clock
  TaskError error;
  scope::Geometry scope;
  std::optional<Eigen::Isometry3d> insertion_point_T_tip;  // with the shaft's axes; without it, no cone and no horizon
  double d2_doubt = 0.0;                                   // m, by which d2 may be less or more
  double pose_time = 0.0;                                  // s, of the scope's pose, on the same clock
  double period = 0.0;                                     // s, since the last command, 0 for the first
};

struct ServoLimits {
  double scale = 1.0;             // 0 to 1, of all velocities and their limits
  bool insertion_allowed = true;  // false: not deeper
  // In and out, and about the shaft; the other axes go on as they are.
  double insertion = std::numeric_limits<double>::infinity();  // m/s
  double spin = std::numeric_limits<double>::infinity();       // rad/s
};

class ScopeServo {
 public:
  // The configuration must be valid.
  explicit ScopeServo(const ControllerConfig& config);

  // The command; not finite where the law's velocity is not.
  scope::Velocity command(const ServoInput& input, const ServoLimits& limits);

  // The command for a velocity that somebody else wants, finite: without a law, within the same limits and range and
  // through the same dead zone. What the input says of an image does not count.
  scope::Velocity drive(const ServoInput& input, const scope::Velocity& wanted);

  // From the next command on: the laws' gains, the bands of rest, the significance of the target's motion. All else of
  // the configuration, which must be valid, is left aside. The limits of acceleration hold across the change. Does not
  // allocate.
  void retune(const ControllerConfig& config);

  // What the robot says that it executed at `time` [s], on the clock of the commands; from this the delay is measured.
  void report(double time, const scope::Velocity& velocity);

  // The arm has been told to stand still since `time`: what was in the way of motion starts anew.
  void stop(double time);

  // Another task begins: as stop(), and what was seen of the target is forgotten. What the robot has been told is not.
  void restart(double time);

  // Forgets everything.
  void reset();

  // Of the gains, 1 unless the loop has swung.
  double gainFactor() const { return oscillation_.factor(); }

  // Hz, of the breath that is followed; 0 when none is.
  double breathingRate() const { return breathing_.rate(); }

  // The last command was cut at a bound of the range.
  bool atBound() const { return at_bound_; }

  // The robot says that it does not do what it was told.
  bool blocked() const { return blocked_; }

  // What the robot has been told, after its dead zone.
  const CommandHistory& history() const { return history_; }

  // s, from a command to its execution.
  double delay() const { return config_.predictor.measure_delay ? delay_.delay() : config_.predictor.delay; }

 private:
  const ControlLaw& law() const;
  void observe(const ServoInput& input);
  scope::Velocity send(const ServoInput& input, scope::Velocity velocity);
  void forgetTarget();
  scope::Velocity following(const Features& velocity) const;
  TaskError oriented(const ServoInput& input) const;
  void remember(double time, const scope::Velocity& executed);

  ControllerConfig config_;
  PaperLaw paper_law_;
  FeatureLaw feature_law_;
  HysteresisBand band_;
  OscillationGuard oscillation_;
  SlewLimiter limiter_;
  CommandHistory history_;
  DelayEstimator delay_;
  TargetMotion target_;
  Breathing breathing_;
  double image_time_ = 0.0;  // s, of the last image
  TaskError error_;          // in it
  bool has_image_ = false;
  bool at_bound_ = false;
  bool blocked_ = false;
  double blocked_since_ = 0.0;                         // s
  Eigen::Vector2d desired_ = Eigen::Vector2d::Zero();  // of the region that is servoed, and below
  Eigen::Vector3d m_star_ = Eigen::Vector3d::Zero();
  Eigen::Matrix4d jacobian_ = Eigen::Matrix4d::Identity();  // of the features at the reference, see target_motion.h
  Eigen::Vector4d displacement_ = Eigen::Vector4d::Zero();  // of the scope at the last image, since the first
  Eigen::Vector4d to_target_ = Eigen::Vector4d::Zero();     // in the last image
  double turn_ = 0.0;                                       // rad, of the last command, alpha
};

}  // namespace laparoscope_servo::servo
