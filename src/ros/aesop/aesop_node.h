// The aesop node: topics, services and tf around aesop::Driver and a serial port. Their units: doc/nodes/aesop.md.
//
// One thread, one loop at a steady rate: a ROS clock that stops or jumps does not affect the watchdogs.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <std_msgs/Empty.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <memory>
#include <string>

#include "laparoscope_servo/ScopeVelocity.h"
#include "laparoscope_servo/aesop/transport.h"
#include "ros/aesop/aesop_diagnostics.h"
#include "ros/aesop/aesop_parameters.h"
#include "ros/aesop/arm_publisher.h"
#include "ros/aesop/calibration_services.h"
#include "ros/common/external_stops.h"
#include "ros/common/input_owner.h"
#include "ros/common/said_lines.h"
#include "ros/common/service_callers.h"
#include "ros/common/service_errors.h"
#include "ros/common/state_report.h"

namespace laparoscope_servo {

class AesopNode {
 public:
  // Throws std::invalid_argument when the parameters are not valid.
  AesopNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node, const AesopParameters& parameters);

  // Runs until `stop` returns true or ROS shuts down, then disables the arm and waits a moment for the confirmation.
  // Also disables the arm before it passes on an exception, and before it throws std::runtime_error because the ROS
  // master is not that of the start any more.
  void run(const std::function<bool()>& stop);

 private:
  using Response = std_srvs::Trigger::Response;

  void step();
  // Exchanges bytes with the line, if it is open.
  void exchange(double now);
  void connect(double now);
  void lose(const std::string& reason, double now);
  void shutDown(const std::function<void()>& step);
  // Steps until `done` is true, at most for `seconds`; returns `done`.
  bool stepUntil(const std::function<bool()>& done, double seconds);
  static bool repeatUntil(const std::function<bool()>& done, double seconds, const std::function<void()>& step);

  void onCommand(const ros::MessageEvent<ScopeVelocity const>& event);
  // Any publisher may stop the arm. Works without a ROS master, over open connections.
  void onStop(const ros::MessageEvent<std_msgs::Empty const>& event);
  void stopArm(const std::string& reason, double now);
  void watchOutside(double now);

  // Each returns the response of the service.
  Response enable();
  Response disable();
  Response clearFault();
  Response pause();
  Response resume();
  using Action = Response (AesopNode::*)();
  // Whether every node may call a service, or only the nodes named by the configuration.
  enum class Callers { kAll, kNamed };
  void advertise(const std::string& name, Action action, Callers callers);

  void watchRecording();
  // The driver's state, with the node whose commands were refused, which the driver does not know.
  aesop::OperatingState state(double now) const;
  void reportState(double now);

  AesopParameters parameters_;
  std::unique_ptr<aesop::WireLogFile> recording_;  // must outlive the driver; null: no recording
  bool recording_ended_ = false;                   // its end was reported
  aesop::Driver driver_;
  aesop::Reconnect reconnect_;
  InputOwner command_owner_;
  ServiceCallers callers_;
  ServiceErrors service_errors_;
  aesop::SerialTransport transport_;
  CalibrationServices calibration_;
  AesopDiagnostics reported_;
  double next_diagnostics_ = 0.0;  // s, steady
  SaidLines refused_lines_;
  SaidLines stranger_lines_;
  StateReport state_report_;
  ExternalStops stops_;

  ros::NodeHandle node_;
  ros::NodeHandle private_node_;
  ArmPublisher publisher_;
  ros::Subscriber command_subscriber_;
  ros::Subscriber stop_subscriber_;
  std::vector<ros::ServiceServer> services_;
  diagnostic_updater::Updater diagnostics_;
};

}  // namespace laparoscope_servo
