// The controller: computes the command for the scope from a task error and a depth, or from a manual command; or zero,
// with a reason.
//
// The scope moves in the state SERVO only, see safety_facts.h; all other states command exactly zero, at once.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/scope/velocity.h"
#include "laparoscope_servo/servo/controller_config.h"
#include "laparoscope_servo/servo/insertion_point_estimator.h"
#include "laparoscope_servo/servo/manual_input.h"
#include "laparoscope_servo/servo/parallel_figures.h"
#include "laparoscope_servo/servo/safety_facts.h"
#include "laparoscope_servo/servo/task.h"
#include "laparoscope_servo/servo/task_error_input.h"

namespace laparoscope_servo::servo {

struct DepthInput {
  std::string problem = "depth d2 is unknown";  // why the pose cannot be used; empty: it can
  double d2 = 0.0;                              // m, along the shaft from the insertion point to the camera
  Eigen::Matrix3d camera_R_shaft = Eigen::Matrix3d::Identity();  // rotation of the optics, see scope/geometry.h
  // Pose of the shaft's tip in the insertion point's frame, with the shaft's axes; empty: not known.
  std::optional<Eigen::Isometry3d> insertion_point_T_tip;
  bool pose_is_new = true;      // false: the pose of the last step again
  double lateral_offset = 0.0;  // m, distance of the insertion point from the shaft
  double age = 0.0;             // s
};

// The robot's report of its own motion.
struct RobotReport {
  bool present = false;      // true: a new report
  double age = 0.0;          // s, since the reported motion
  scope::Velocity velocity;  // measured velocity of the scope
};

struct ControllerInput {
  double time = 0.0;          // s, on a clock that never jumps
  std::string clock_jump;     // description of a jump of another clock since the last step; empty: none
  std::string ended;          // what has ended the engagement since the last step; empty: nothing
  TaskErrorInput task_error;  // of HOLD_VIEW: of the region of interest
  TaskErrorInput tip;         // of CENTRE_TIP: see placeError()
  TaskErrorInput view;        // of STABILISE and PARALLEL: of viewRegion(), from the anchor image to this one
  TaskErrorInput object;      // of FOLLOW: see placeError()
  TaskErrorInput points;      // of POINTS: see points_error.h
  TaskErrorInput position;    // of POSITION: see position_error.h
  ManualInput manual;         // unusable input stops the scope at once
  DepthInput depth;
  RobotReport robot_report;
  RobotFacts robot;       // used if safety/robot_required
  DeadManFacts dead_man;  // used if safety/dead_man_required

  // What `task` goes by; in MANUAL nothing is.
  const TaskErrorInput& seenBy(Task task) const;
  TaskErrorInput& seenBy(Task task);
};

using ControllerState = SafetyState;

struct ControllerOutput {
  ControllerState state = ControllerState::kIdle;
  std::string reason;   // reason for the state, never empty; without numbers that change from one step to the next
  std::string caution;  // in SERVO: what slows the scope or keeps it from going deeper; empty: nothing
  double speed_scale = 0.0;
  Task task = Task::kHoldView;
  scope::Velocity command;
  bool engaged() const { return isEngaged(state); }
};

// The controller's estimates, for display and diagnostics.
struct ControllerFigures {
  // Point where the shafts of the last poses meet, in the insertion point's frame. Its distance from the origin is the
  // error of the calibration.
  InsertionPointEstimate insertion_point;
  double insertion_point_residual = 0.0;  // m, root mean square distance of the last shafts from that point
  double delay = 0.0;                     // s, from a command to its execution
  double breathing_rate = 0.0;            // Hz, breathing rate that is compensated; 0: none
  double gain_factor = 1.0;               // factor on the gains, below 1 after an oscillation of the loop
  double evidence = 0.0;                  // log likelihood ratio of the best fault hypothesis over none
  double unconfirmed = 0.0;               // used share of the motion that is allowed before its effect is confirmed
  double leash = 0.0;                     // used share of the leash, see src/servo/safety/leash.h
  ParallelFigures parallel;               // of the task PARALLEL
};

class Controller {
 public:
  // Throws std::invalid_argument with all errors when the configuration is not valid.
  explicit Controller(const ControllerConfig& config);
  ~Controller();
  Controller(Controller&&) noexcept;
  Controller& operator=(Controller&&) noexcept;

  // Allows motion. Returns the reason of a refusal, or an empty text when engaged. Refused if anything that motion
  // relies on is missing, except the dead-man switch. Has no effect when engaged already.
  std::string engage(const ControllerInput& input);

  // Back to IDLE, from every state; `reason` is kept for the output.
  void disengage(const std::string& reason);

  // Stops at `time` [s] on request from outside of the control: the state becomes IDLE, or FAULT if the clock has
  // jumped since the last update, since the arm's motion meanwhile is unknown. Has no effect if not engaged.
  void stop(const std::string& reason, double time);

  // Switches to another task: the next command is zero, and the task starts from rest. Does not engage and clears no
  // state; inputs that the new task misses end the motion as usual. Has no effect for the present task.
  void select(Task task);

  ControllerOutput update(const ControllerInput& input);

  // Takes the gains and thresholds of `config`, which must be valid, between two updates and in any state; its other
  // parameters are ignored. Does not allocate.
  void retune(const ControllerConfig& config);

  // The reason why engage() would be refused, or why motion ends; empty when nothing is missing.
  std::string problem(const ControllerInput& input) const;

  bool engaged() const;
  Task task() const;

  // The present estimates.
  ControllerFigures figures() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace laparoscope_servo::servo
