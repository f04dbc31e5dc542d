// Computes velocities of the scope from task errors: law, predictor, target motion, hysteresis band, limits, dead zone.
//
// The task error of an image is predicted to the time when the present command will be executed, from the commands that
// are not executed yet and from the target's own motion. The law gets that error. The safety states are in
// controller.h.
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
#include "servo/servo_use.h"
#include "servo/shaping/hysteresis_band.h"
#include "servo/shaping/oscillation_guard.h"
#include "servo/shaping/slew_limiter.h"
#include "servo/task/scope_displacement.h"

namespace laparoscope_servo::servo {

struct ServoInput {
  double time = 0.0;        // s, of the command
  double image_time = 0.0;  // s, of the exposure, on the same clock
  TaskError error;
  double region = 0.0;  // identifies what the error is of: another one is another target
  scope::Geometry scope;
  // with the shaft's axes; if empty, cone and horizon are not used
  std::optional<Eigen::Isometry3d> insertion_point_T_tip;
  double d2_doubt = 0.0;   // m, uncertainty of d2
  double pose_time = 0.0;  // s, of the scope's pose, on the same clock
  double period = 0.0;     // s, since the last command, 0 for the first
};

struct ServoLimits {
  double scale = 1.0;             // 0 to 1, factor on all velocities and their limits
  bool insertion_allowed = true;  // false: not deeper
  // Limits of the magnitudes of insertion and spin, beside those of the configuration.
  double insertion = std::numeric_limits<double>::infinity();  // m/s
  double spin = std::numeric_limits<double>::infinity();       // rad/s
};

class ScopeServo {
 public:
  // The configuration must be valid.
  explicit ScopeServo(const ControllerConfig& config);

  // The command by the law; not finite if the law's velocity is not.
  scope::Velocity command(const ServoInput& input, const ServoLimits& limits);

  // From the scope's place when the image was taken to where the task error is zero, as a displacement (pan, tilt, spin
  // [rad], insertion [m]); not finite if that is not known.
  Eigen::Vector4d toTarget(const ServoInput& input) const {
    return displacementToTarget(oriented(input), input.scope, config_.features.desired_depth);
  }

  // The scope's displacement from the time of the image to that of its pose, by the commands.
  Eigen::Vector4d sinceImage(const ServoInput& input) const;

  // The command for a given finite velocity: no law, but the same limits, workspace and dead zone. The image part of
  // `input` is not used.
  scope::Velocity drive(const ServoInput& input, const scope::Velocity& wanted);

  // Takes from `config`, which must be valid, the laws' gains, the bands of rest and the significance of the target's
  // motion, for the next command on; its other parameters are ignored. The limits of acceleration hold across the
  // change. Does not allocate.
  void retune(const ControllerConfig& config);

  // Takes the velocity reported for `time` [s], on the clock of the commands; used to measure the delay.
  void report(double time, const scope::Velocity& velocity);

  // Call while the command is zero since `time`: limits and bands start anew.
  void stop(double time);

  // Call when another task begins: as stop(), and forgets the target, but not the commands sent.
  void restart(double time);

  // How the task that begins uses the law; with restart().
  void setUse(const ServoUse& use);
  const ServoUse& use() const { return use_; }

  // Forgets everything.
  void reset();

  // Factor on the gains; below 1 after an oscillation.
  double gainFactor() const { return oscillation_.factor(); }

  // Breathing rate that is compensated [Hz]; 0: none.
  double breathingRate() const { return use_.is_tissue ? breathing_.rate() : 0.0; }

  // Whether the last command was cut at a bound of the workspace.
  bool atBound() const { return at_bound_; }

  // Whether the robot reports that it does not execute its commands.
  bool blocked() const { return blocked_; }

  // The commands to the robot, after its dead zone.
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
  ServoUse use_;
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
  TaskError error_;          // task error of the last image
  bool has_image_ = false;
  bool at_bound_ = false;
  bool blocked_ = false;
  double blocked_since_ = 0.0;  // s
  double region_ = 0.0;
  Eigen::Vector2d desired_ = Eigen::Vector2d::Zero();  // reference place of the present region, with m_star_
  Eigen::Vector3d m_star_ = Eigen::Vector3d::Zero();
  // Jacobian of the features at the reference, see target_motion.h
  Eigen::Matrix4d jacobian_ = Eigen::Matrix4d::Identity();
  // displacement of the scope from the first to the last image
  Eigen::Vector4d displacement_ = Eigen::Vector4d::Zero();
  Eigen::Vector4d to_target_ = Eigen::Vector4d::Zero();  // displacement to the target in the last image
  double turn_ = 0.0;                                    // rad, error of alpha at the last command
};

}  // namespace laparoscope_servo::servo
