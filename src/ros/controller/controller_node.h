// The controller as a node: task error and tf in, scope velocity out.
//
// Subscribes `task_error` (TaskError), `motion_features` (TrackedFeatures), `camera_info`, `~manual` (ScopeVelocity),
// `~stop` (std_msgs/Empty) and, where they are required, `operating_state` (OperatingState) and `dead_man`
// (std_msgs/Bool), see controller_inputs.h; publishes `servo_command` (ScopeVelocity, at a fixed rate, zero unless the
// arm may move), `~state` (ControllerState, latched), `~tissue_plane` (visualization_msgs/MarkerArray, latched, what
// PARALLEL knows) and diagnostics; services `~engage` (std_srvs/SetBool),
// `~select_task` (SelectTask). d2 comes from tf. The rate and all ages run on a steady clock: ROS time that stands
// still or jumps back stops the arm. Not thread-safe: one thread calls all callbacks.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <laparoscope_servo/SelectTask.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>

#include <functional>
#include <string>

#include "laparoscope_servo/servo/controller.h"
#include "ros/common/external_stops.h"
#include "ros/common/reconfigure_server.h"
#include "ros/common/service_errors.h"
#include "ros/controller/controller_inputs.h"
#include "ros/controller/controller_parameters.h"
#include "ros/controller/scope_pose.h"

namespace laparoscope_servo {

class ControllerNode {
 public:
  // Throws std::invalid_argument when the configuration is not valid.
  ControllerNode(ros::NodeHandle node, ros::NodeHandle private_node, const ControllerNodeConfig& config);

  // Calls all callbacks until `stop` returns true, and leaves the arm with a command of zero, also if a callback
  // throws: then the state is FAULT. Returns the exit status of the process; publishers are still open.
  int run(const std::function<bool()>& stop);

 private:
  void fail(const std::string& what);
  void onStop(const std::string& sender);
  bool onSelectTask(SelectTask::Request& request, SelectTask::Response& response);
  bool onEngage(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  void engage(bool on, std_srvs::SetBool::Response& response);
  void selectTask(const std::string& task, SelectTask::Response& response);
  void onTick();
  void checkTime();
  // Disengages if a stop from outside of ROS, or the end of its master, stops the arm.
  void watchOutside();
  servo::ControllerInput input();
  void publish(const servo::ControllerOutput& output);
  void publishState(const servo::ControllerOutput& output);
  void publishPlane();
  void warn(const std::string& caution);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  ControllerNodeConfig config_;
  servo::Controller controller_;
  ControllerNodeConfig changed_;  // buffer for live_.take()
  ExternalStops stops_;
  ServiceErrors service_errors_;
  ScopePose scope_pose_;
  ros::Time last_now_;
  std::string clock_jump_;  // clock jump since the last step; empty: none
  servo::ControllerInput last_input_;
  servo::ControllerOutput last_output_;
  bool state_published_ = false;
  Eigen::Vector3d plane_published_ = Eigen::Vector3d::Zero();  // its normal; zero: none
  std::string said_caution_;                                   // last caution on the terminal
  double next_caution_ = 0.0;                                  // s, steady

  ControllerInputs inputs_;
  diagnostic_updater::Updater diagnostics_;
  ros::Publisher command_publisher_;
  ros::Publisher state_publisher_;
  ros::Publisher plane_publisher_;
  ros::ServiceServer engage_service_;
  ros::ServiceServer select_task_service_;
  ros::SteadyTimer tick_timer_;
  ros::SteadyTimer diagnostics_timer_;
  LiveParameters<ControllerNodeConfig> live_;
};

}  // namespace laparoscope_servo
