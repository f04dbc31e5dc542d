// The aesop node: topics, services and tf around aesop::Driver and a serial port. doc and units: README, node `aesop`.
//
// One thread, one loop at a steady rate: neither a standing nor a jumping ROS clock touches the watchdogs.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <atomic>
#include <functional>
#include <string>

#include "laparoscope_servo/ScopeVelocity.h"
#include "laparoscope_servo/aesop/transport.h"
#include "laparoscope_servo/ros/aesop_parameters.h"
#include "laparoscope_servo/ros/calibration_services.h"

namespace laparoscope_servo::skin {

class AesopNode {
 public:
  // Throws std::invalid_argument when the parameters are not valid.
  AesopNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node, const AesopParameters& parameters);

  // Runs until `stop` becomes true or ROS shuts down, then disables the arm and waits a moment for it to be confirmed.
  void run(const std::atomic<bool>& stop);

 private:
  using Request = std_srvs::Trigger::Request;
  using Response = std_srvs::Trigger::Response;

  void step();
  void connect(double now);
  void lose(const std::string& reason, double now);
  void shutDown();
  // Steps until `done` or for `seconds`; says whether it is done.
  bool stepUntil(const std::function<bool()>& done, double seconds);

  void onCommand(const ScopeVelocity& message);
  bool enable(Request& request, Response& response);
  bool disable(Request& request, Response& response);
  bool clearFault(Request& request, Response& response);
  bool pause(Request& request, Response& response);
  bool resume(Request& request, Response& response);

  void publishStatus();
  void publishState(double now);
  void publishStaticFrames();
  void describe(diagnostic_updater::DiagnosticStatusWrapper& status);

  AesopParameters parameters_;
  Eigen::Matrix3d tip_R_optical_;
  aesop::Driver driver_;
  aesop::SerialTransport transport_;
  CalibrationServices calibration_;
  std::string line_warning_;
  double next_attempt_ = 0.0;      // s, steady: to open the port
  double next_diagnostics_ = 0.0;  // s, steady
  double next_report_ = 0.0;       // s, steady: of a refused command
  std::string last_loss_;
  std::uint64_t published_ = 0;  // statuses received when the last one was published
  std::uint64_t errors_reported_ = 0;
  aesop::OperatingState last_state_;
  bool state_published_ = false;
  double state_time_ = 0.0;  // s, steady, of the last publication

  ros::NodeHandle node_;
  ros::NodeHandle private_node_;
  ros::Publisher joint_publisher_;
  ros::Publisher pose_publisher_;
  ros::Publisher twist_publisher_;
  ros::Publisher state_publisher_;
  ros::Subscriber command_subscriber_;
  std::vector<ros::ServiceServer> services_;
  tf2_ros::TransformBroadcaster broadcaster_;
  tf2_ros::StaticTransformBroadcaster static_broadcaster_;
  diagnostic_updater::Updater diagnostics_;
};

}  // namespace laparoscope_servo::skin
