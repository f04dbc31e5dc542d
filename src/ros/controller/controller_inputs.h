// What other nodes tell the controller, and which of it counts.
//
// Each topic has one owner (input_owner.h), each stamp its range (stamp_gate.h). What does not count is left out,
// counted and named. While engaged, the owner's name on another connection ends the engagement, and so does a robot
// that says that it was stopped, whatever comes after it before the next step.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <geometry_msgs/TwistStamped.h>
#include <laparoscope_servo/OperatingState.h>
#include <laparoscope_servo/ScopeVelocity.h>
#include <laparoscope_servo/TaskError.h>
#include <ros/ros.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Empty.h>

#include <functional>
#include <limits>
#include <string>

#include "laparoscope_servo/servo/controller.h"
#include "laparoscope_servo/servo/dead_man_switch.h"
#include "ros/common/input_owner.h"
#include "ros/common/stamp_gate.h"
#include "ros/common/stamp_watch.h"
#include "ros/controller/controller_parameters.h"

namespace laparoscope_servo {

class ControllerInputs {
 public:
  struct Calls {
    std::function<void()> check_time;                     // before a stamp is compared with ROS time
    std::function<void(const std::string& sender)> stop;  // somebody stops the arm
    // Rotation from a frame's axes to the shaft's; nothing: unknown.
    std::function<std::optional<Eigen::Quaterniond>(const std::string& frame)> shaft_from;
  };

  // Subscribes.
  ControllerInputs(ros::NodeHandle& node, ros::NodeHandle& private_node, const ControllerNodeConfig& config,
                   const Calls& calls);

  // After each step of the controller, and each request to it: what it does.
  void know(bool engaged, servo::Task task);
  // Somebody engages.
  void engaging() { dead_man_.engaging(); }
  // ROS time jumped back: what was known has stamps of another time.
  void forgetStamps();

  // All but depth and clocks; adds what has happened since the last taken().
  void fill(servo::ControllerInput& input, double steady_now) const;
  void taken();

  // Owners, publishers, and what was left out. WARN where somebody else publishes.
  void describe(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  // A topic, by whom it may be published, and what was left out of it for its stamp.
  struct Input {
    Input(const std::string& name, const std::string& what, const std::string& parameter, double tolerance)
        : owner(name, what, parameter), stamps(tolerance) {}
    InputOwner owner;
    StampGate stamps;
    ros::Subscriber subscriber;
    double next_complaint = 0.0;  // s, steady
    bool several = false;         // publishers; it was said
  };

  template <typename Message>
  bool counts(Input& input, const ros::MessageEvent<Message const>& event, bool matters);
  bool manualMatters() const { return engaged_ && task_ == servo::Task::kManual; }
  bool isAhead(Input& input, const ros::Time& stamp) const;
  void onTaskError(const ros::MessageEvent<TaskError const>& event);
  void onOperatingState(const ros::MessageEvent<OperatingState const>& event);
  void onMeasuredVelocity(const ros::MessageEvent<geometry_msgs::TwistStamped const>& event);
  void onManual(const ros::MessageEvent<ScopeVelocity const>& event);
  void onDeadMan(const ros::MessageEvent<std_msgs::Bool const>& event);
  void onStop(const ros::MessageEvent<std_msgs::Empty const>& event);
  void end(const std::string& why);
  static void describe(Input& input, diagnostic_updater::DiagnosticStatusWrapper& status);

  ControllerNodeConfig config_;
  Calls calls_;
  bool engaged_ = false;
  servo::Task task_ = servo::Task::kHoldView;
  std::string ended_;       // the engagement, since taken()
  std::string clock_jump_;  // the same

  Input task_error_input_;
  Input operating_state_input_;
  Input measured_velocity_input_;
  Input manual_input_;
  Input dead_man_input_;
  ros::Subscriber stop_subscriber_;

  servo::TaskErrorInput task_error_;
  StampWatch task_error_watch_;
  servo::RobotFacts robot_;
  ros::Time robot_stamp_;
  double robot_arrival_ = 0.0;  // s, steady
  ScopeVelocity manual_;
  double manual_arrival_ = -std::numeric_limits<double>::infinity();  // s, steady
  servo::DeadManSwitch dead_man_;
  servo::RobotReport robot_report_;
  double robot_report_arrival_ = 0.0;  // s, steady, of what it tells
};

}  // namespace laparoscope_servo
