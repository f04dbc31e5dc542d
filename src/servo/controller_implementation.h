// The parts of the controller, and the order of a step.
#pragma once

#include <optional>
#include <string>

#include "laparoscope_servo/servo/controller.h"
#include "servo/prediction/slow_correction.h"
#include "servo/safety/effect_guard.h"
#include "servo/safety/leash.h"
#include "servo/safety/manual_stick.h"
#include "servo/safety/opposed_motion.h"
#include "servo/safety/repeat_watch.h"
#include "servo/safety/safety_machine.h"
#include "servo/safety/usual_age.h"
#include "servo/scope_servo.h"
#include "servo/task/parallel/keyed_view.h"
#include "servo/task/parallel/parallel_task.h"
#include "servo/task/tip_stillness.h"

namespace laparoscope_servo::servo {

class Controller::Implementation {
 public:
  explicit Implementation(const ControllerConfig& config);

  std::string engage(const ControllerInput& input);
  void disengage(const std::string& reason) { end(reason, last_time_); }
  void stop(const std::string& reason, double time) {
    if (engaged()) end(reason, time);
  }
  void select(Task task);
  ControllerOutput update(const ControllerInput& input);
  void retune(const ControllerConfig& config) { servo_.retune(config); }
  std::string problem(const ControllerInput& input) const;
  bool engaged() const { return isEngaged(machine_.state()); }
  Task task() const { return task_; }
  ControllerFigures figures() const;

 private:
  void end(const std::string& reason, double time);
  SafetyFacts facts(const ControllerInput& input) const;
  const TaskErrorInput& seen(const ControllerInput& input) const;
  std::string problemOf(const TaskErrorInput& seen) const;
  double d2(const ControllerInput& input) const;
  void correctDepth(const ControllerInput& input);
  bool isUsable(const ControllerInput& input) const;
  void watchEffect(const ControllerInput& input);
  void watchLeash(const ControllerInput& input);
  EffectFacts effectFacts() const;
  ServoLimits limits(const SafetyOutput& safety, double time) const;
  ServoInput servoInput(const ControllerInput& input) const;
  void watchRepetition(const TaskErrorInput& task_error);
  void watchAge(const TaskErrorInput& seen, double time);
  void watchTip(const TaskErrorInput& tip);
  void watchPlane(const ControllerInput& input);
  std::string planeProblem(const ControllerInput& input) const;
  scope::Velocity faceTissue(const ControllerInput& input, const SafetyOutput& safety);
  scope::Velocity follow(const ControllerInput& input, const SafetyOutput& safety);
  scope::Velocity drive(const ControllerInput& input, const std::string& problem);
  std::string caution(const SafetyOutput& safety, const std::string& stick) const;

  ControllerConfig config_;
  ScopeServo servo_;
  SafetyMachine machine_;
  Task task_ = Task::kHoldView;
  bool task_changed_ = false;  // since the last step
  ManualStick stick_;
  TipStillness tip_;
  ParallelTask parallel_;
  KeyedView keyed_view_;
  RepeatWatch repeats_;
  UsualAge usual_age_;
  EffectGuard effect_;
  OpposedMotion opposed_;
  Leash leash_;
  std::optional<double> moves_since_;  // s; empty: the command is within the dead zone
  InsertionPointEstimator insertion_point_;
  SlowCorrection d2_correction_;                    // m
  Eigen::Vector4d told_ = Eigen::Vector4d::Zero();  // the last command to the robot, after its dead zone
  bool has_time_ = false;
  double last_time_ = 0.0;  // s, of the last step
};

}  // namespace laparoscope_servo::servo
