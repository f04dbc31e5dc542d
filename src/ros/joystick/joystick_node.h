// The node `joystick`: a joystick of the Linux joystick API as dead-man switch and as stick of the task MANUAL.
//
// Publishes: dead_man (std_msgs/Bool) and controller/manual (ScopeVelocity) by Stick, /diagnostics. A device that is
// missing is looked for once a second; meanwhile the node publishes neither.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "laparoscope_servo/parameters/table.h"
#include "ros/joystick/joystick_device.h"
#include "ros/joystick/joystick_events.h"
#include "ros/joystick/stick.h"

namespace laparoscope_servo {

struct JoystickNodeConfig {
  std::string device = "/dev/input/js0";
  double rate = 20.0;  // Hz, 10 to 100, of the messages
  StickConfig stick;
};

// Adds the rows of the private parameters.
void describe(parameters::Table& table, JoystickNodeConfig& config);
std::vector<std::string> validate(const JoystickNodeConfig& config);

class JoystickNode {
 public:
  JoystickNode(ros::NodeHandle node, ros::NodeHandle private_node, const JoystickNodeConfig& config);

  // Runs until the node's end.
  void run();

 private:
  void open(double now);
  // Returns whether a control was released.
  bool read(double now);
  void close(const std::string& why);
  void say(double now);
  void tellProblem();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  JoystickNodeConfig config_;
  Stick stick_;
  std::unique_ptr<JoystickDevice> device_;
  JoystickEvents events_;
  ros::Publisher dead_man_publisher_;
  ros::Publisher manual_publisher_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer diagnostics_timer_;
  double next_open_ = 0.0;   // s, steady
  std::string why_closed_;   // why there is no device
  std::string told_;         // the last problem in the log
  std::uint64_t count_ = 0;  // number of events since the start
};

}  // namespace laparoscope_servo
