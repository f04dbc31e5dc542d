// The controller: from a task error and a depth, or from a manual command, to a command for the scope, or to zero with
// a reason.
//
// The scope moves in the state SERVO only, see safety_facts.h; whatever is not SERVO commands exactly zero, at once.
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
#include "laparoscope_servo/servo/safety_facts.h"
#include "laparoscope_servo/servo/task_error_input.h"

namespace laparoscope_servo::servo {

// What moves the scope in SERVO.
enum class Task {
  kHoldView,  // the control law, so that the region of interest stays where it is
  kManual,    // somebody, by four velocities. Nothing that comes from a camera counts
};

struct DepthInput {
  std::string problem = "depth d2 is unknown";  // why it cannot be used; empty: it can
  double d2 = 0.0;                              // m, along the shaft from the insertion point to the camera
  Eigen::Matrix3d camera_R_shaft = Eigen::Matrix3d::Identity();  // the optics, see scope/geometry.h
  // Where the shaft's tip is in the insertion point's frame, with the shaft's axes; nothing: not known.
  std::optional<Eigen::Isometry3d> insertion_point_T_tip;
  bool pose_is_new = true;      // not the one of the last step again
  double lateral_offset = 0.0;  // m, of the insertion point from the shaft
  double age = 0.0;             // s
};

// What the robot says of its own motion.
struct RobotReport {
  bool present = false;      // there is a new one
  double age = 0.0;          // s, since it was so
  scope::Velocity velocity;  // of the scope
};

struct ControllerInput {
  double time = 0.0;       // s, on a clock that never jumps
  std::string clock_jump;  // which other clock jumped since the last step, in words; empty: none
  std::string ended;       // what has ended the engagement since the last step, in words; empty: nothing
  TaskErrorInput task_error;
  ManualInput manual;  // what cannot be used lets the scope stand, at once
  DepthInput depth;
  RobotReport robot_report;
  RobotFacts robot;       // where the configuration requires it
  DeadManFacts dead_man;  // the same
};

using ControllerState = SafetyState;

struct ControllerOutput {
  ControllerState state = ControllerState::kIdle;
  std::string reason;   // why it is this state, never empty; without numbers that change from one step to the next
  std::string caution;  // in SERVO: what slows the scope or lets it go no deeper; empty: nothing
  double speed_scale = 0.0;
  Task task = Task::kHoldView;
  scope::Velocity command;
  bool engaged() const { return isEngaged(state); }
};

// What the controller has found out, for those who watch it.
struct ControllerFigures {
  // Where the shafts of the last poses meet, in the insertion point's frame: where it is not at the origin, the
  // calibration is off.
  InsertionPointEstimate insertion_point;
  double insertion_point_residual = 0.0;  // m, root mean square distance of the last shafts from it
  double delay = 0.0;                     // s, from a command to its execution
  double breathing_rate = 0.0;            // Hz, of the breath that is followed; 0: none is
  double gain_factor = 1.0;               // of the gains, 1 unless the loop has swung
  double evidence = 0.0;                  // log of the ratio of likelihoods, a fault in the picture over none
  double unconfirmed = 0.0;               // share of the motion that is allowed before its effect is seen
};

class Controller {
 public:
  // Throws std::invalid_argument with all errors when the configuration is not valid.
  explicit Controller(const ControllerConfig& config);
  ~Controller();
  Controller(Controller&&) noexcept;
  Controller& operator=(Controller&&) noexcept;

  // Allows motion. Refused unless everything that motion relies on is there, but for the dead-man switch: returns why,
  // or nothing when engaged. Once engaged, it has no effect.
  std::string engage(const ControllerInput& input);

  // Back to IDLE, from every state; `reason` is kept for the output.
  void disengage(const std::string& reason);

  // Something outside of the control asks for a stop at `time` [s]: IDLE, but FAULT where the clock has jumped since the
  // last update, as nobody knows what the arm did meanwhile. Without effect where nothing is engaged.
  void stop(const std::string& reason, double time);

  // Another task: the next command is zero, and the task starts from rest. Engages nothing, clears nothing; what the
  // new task misses ends the motion as ever. The same task again has no effect.
  void select(Task task);

  ControllerOutput update(const ControllerInput& input);

  // Other gains and thresholds between two updates, whatever the state; all else of the configuration, which must be
  // valid, is left aside. Does not allocate.
  void retune(const ControllerConfig& config);

  // Why engage() would be refused, or motion ends; empty when nothing is missing.
  std::string problem(const ControllerInput& input) const;

  bool engaged() const;
  Task task() const;

  // What it has found out.
  ControllerFigures figures() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace laparoscope_servo::servo
