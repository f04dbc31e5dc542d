// The controller: from a task error and a depth to a command for the scope, or to zero with a reason.
//
// States: IDLE, not engaged; SERVO, the command follows the law; HOLD, engaged, but something that the motion relies on
// is missing. A hold that ends within `resume_time` goes back to SERVO by itself, so that an instrument may cross the
// ROI; after a longer one, somebody has to look at the arm and engage again. Whatever is not SERVO commands exactly
// zero, at once.
#pragma once

#include <string>

#include "laparoscope_servo/servo/controller_config.h"
#include "laparoscope_servo/servo/scope_servo.h"

namespace laparoscope_servo::servo {

struct TaskErrorInput {
  std::string problem = "no task error was received";  // why there is none that could be used; empty: there is
  bool valid = false;                                  // the tracker's own word
  TaskError error;
  double age = 0.0;  // s, since the image, or since the message came, whichever is more
};

struct DepthInput {
  std::string problem = "depth d2 is unknown";  // why it cannot be used; empty: it can
  double d2 = 0.0;                              // m, along the shaft from the insertion point to the camera
  Eigen::Matrix3d camera_R_shaft = Eigen::Matrix3d::Identity();  // the optics, see scope_geometry.h
  double lateral_offset = 0.0;                  // m, of the insertion point from the shaft
  double age = 0.0;                             // s
};

// What the robot says of its own motion.
struct RobotReport {
  bool present = false;    // there is a new one
  double age = 0.0;        // s, since it was so
  ScopeVelocity velocity;  // of the scope
};

struct ControllerInput {
  double time = 0.0;  // s, on a clock that never jumps
  TaskErrorInput task_error;
  DepthInput depth;
  RobotReport robot_report;
};

enum class ControllerState { kIdle, kServo, kHold };

struct ControllerOutput {
  ControllerState state = ControllerState::kIdle;
  std::string reason;  // why it is not SERVO; without numbers that change from one step to the next
  ScopeVelocity command;
  bool engaged() const { return state != ControllerState::kIdle; }
};

class Controller {
 public:
  // Throws std::invalid_argument with all errors when the configuration is not valid.
  explicit Controller(const ControllerConfig& config);

  // Allows motion. Refused unless everything that motion relies on is there: returns why, or nothing when engaged. Once
  // engaged, it has no effect.
  std::string engage(const ControllerInput& input);

  // Back to IDLE; `reason` is kept for the output.
  void disengage(const std::string& reason);

  // One step. Time that goes back, or is not finite, disengages.
  ControllerOutput update(const ControllerInput& input);

  bool engaged() const { return engaged_; }

 private:
  void hold(double time, const std::string& reason);
  ScopeVelocity servo(const ControllerInput& input);
  ControllerOutput stopped() const;

  ControllerConfig config_;
  ScopeServo servo_;
  bool engaged_ = false;
  bool holding_ = false;
  bool has_time_ = false;
  double last_time_ = 0.0;   // s, of the last step
  double hold_since_ = 0.0;  // s
  std::string reason_ = "not engaged";
};

// What keeps this input from moving the arm; empty when nothing does. Without numbers that change all the time.
std::string problemWith(const ControllerInput& input, const SafetyConfig& safety);

}  // namespace laparoscope_servo::servo
