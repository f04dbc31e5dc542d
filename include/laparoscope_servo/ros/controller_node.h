// The controller as a node: task error and tf in, scope velocity out.
//
// Subscribes `task_error` (TaskError), `~manual` (ScopeVelocity) and, where they are required, `operating_state`
// (OperatingState) and `dead_man` (std_msgs/Bool); publishes `servo_command` (ScopeVelocity, at a fixed rate, zero
// unless the arm may move), `~state` (ControllerState, latched) and diagnostics; services `~engage` (std_srvs/SetBool),
// `~select_task` (SelectTask). d2 comes from tf. The rate and all ages run on a steady clock: ROS time that stands
// still or jumps back stops the arm. Not thread-safe: one thread calls all callbacks.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/TwistStamped.h>
#include <laparoscope_servo/OperatingState.h>
#include <laparoscope_servo/ScopeVelocity.h>
#include <laparoscope_servo/SelectTask.h>
#include <laparoscope_servo/TaskError.h>
#include <ros/ros.h>
#include <std_msgs/Bool.h>
#include <std_srvs/SetBool.h>
#include <tf2_ros/transform_listener.h>

#include <limits>

#include "laparoscope_servo/ros/controller_parameters.h"
#include "laparoscope_servo/ros/external_stops.h"
#include "laparoscope_servo/ros/future_transforms.h"
#include "laparoscope_servo/ros/stamp_watch.h"
#include "laparoscope_servo/ros/static_frame_watch.h"
#include "laparoscope_servo/servo/controller.h"

namespace laparoscope_servo::skin {

class ControllerNode {
 public:
  // Throws std::invalid_argument when the configuration is not valid.
  ControllerNode(ros::NodeHandle node, ros::NodeHandle private_node, const ControllerNodeConfig& config);

  // Disengages and publishes zeros. For the end of the process: call it while publishers are still open.
  void stop();
  // The ROS master is not that of the start any more: the node has to end, for nobody finds it.
  bool mustEnd() const { return stops_.mustEnd(); }

 private:
  void onTaskError(const TaskError& message);
  void onOperatingState(const OperatingState& message);
  void onDeadMan(const std_msgs::Bool& message);
  void onManual(const ScopeVelocity& message);
  bool onSelectTask(SelectTask::Request& request, SelectTask::Response& response);
  void onMeasuredVelocity(const geometry_msgs::TwistStamped& message);
  bool onEngage(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  void onTick();
  void checkTime();
  // Ends what is engaged when something outside of ROS, or the end of its master, stops the arm.
  void watchOutside();
  servo::ControllerInput input();
  servo::DepthInput depth(double steady_now);
  void publish(const servo::ControllerOutput& output);
  void publishState(const servo::ControllerOutput& output);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  ControllerNodeConfig config_;
  servo::Controller controller_;
  ExternalStops stops_;
  servo::TaskErrorInput task_error_;
  StampWatch task_error_watch_;
  StampWatch depth_watch_;
  StaticFrameWatch insertion_point_watch_;
  FutureTransforms future_transforms_;
  servo::RobotFacts robot_;
  double robot_arrival_ = 0.0;  // s, steady
  servo::DeadManFacts dead_man_;
  double dead_man_arrival_ = 0.0;  // s, steady
  ScopeVelocity manual_;
  double manual_arrival_ = -std::numeric_limits<double>::infinity();  // s, steady
  servo::RobotReport robot_report_;
  double robot_report_arrival_ = 0.0;  // s, steady, of what it tells
  ros::Time last_now_;
  std::string clock_jump_;  // since the last step, in words
  servo::ControllerInput last_input_;
  servo::ControllerOutput last_output_;
  bool state_published_ = false;

  tf2_ros::Buffer tf_;
  tf2_ros::TransformListener tf_listener_;
  diagnostic_updater::Updater diagnostics_;
  ros::Publisher command_publisher_;
  ros::Publisher state_publisher_;
  ros::Subscriber task_error_subscriber_;
  ros::Subscriber operating_state_subscriber_;
  ros::Subscriber dead_man_subscriber_;
  ros::Subscriber manual_subscriber_;
  ros::Subscriber measured_velocity_subscriber_;
  ros::ServiceServer engage_service_;
  ros::ServiceServer select_task_service_;
  ros::SteadyTimer tick_timer_;
  ros::SteadyTimer diagnostics_timer_;
};

}  // namespace laparoscope_servo::skin
