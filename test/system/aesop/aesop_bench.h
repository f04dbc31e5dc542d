// The aesop node and the emulator as processes, a pty between them, and a test that watches both: topics on one side,
// the true joints on the other.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/OperatingState.h"
#include "laparoscope_servo/ScopeVelocity.h"
#include "laparoscope_servo/sim/emulator_control_client.h"
#include "ros/common/clocks.h"
#include "support/temporary_folder.h"
#include "system/aesop/child_process.h"

namespace laparoscope_servo::test {

class AesopBench {
 public:
  // Starts the emulator, and the node unless `with_node` is false. The node is named `aesop`, its parameters are those
  // of config/aesop.yaml.
  explicit AesopBench(bool with_node = true, const std::vector<std::string>& emulator_arguments = {});
  ~AesopBench();

  // The arguments are those for a test that runs another program as the node.
  void startNode(const std::string& program = AESOP_NODE, const std::vector<std::string>& arguments = {},
                 const std::string& output = "");
  // Parameters over those of config/aesop.yaml, from the next start on.
  void setParameters(const XmlRpc::XmlRpcValue& overlay) { overlay_ = overlay; }
  ChildProcess& node() { return *node_; }
  ChildProcess& emulator() { return *emulator_; }
  // What only the emulator knows.
  sim::EmulatorControlClient& truth() { return *truth_; }
  std::string port() const { return file("port"); }
  // In a folder of this bench.
  std::string file(const std::string& name) const { return folder_.file(name); }

  // Handles messages until `condition` holds; false after `seconds`.
  bool waitFor(const std::function<bool()>& condition, double seconds = 20.0);
  // The same while a velocity is commanded at 50 Hz, stamped as it should be.
  bool commandUntil(const std::function<bool()>& condition, double pan, double seconds = 20.0);
  void send(double pan, double insertion, const ros::Time& stamp);
  // Stamped now.
  void send(ScopeVelocity command);

  // Enables, and drives the arm until its joints move.
  bool enable();
  std_srvs::Trigger::Response call(const std::string& service);
  bool startMoving();
  bool jointsMove() { return !truth_->motion().qdot.isZero(0.0); }
  // s from now until no joint moves; more than `limit` when they go on.
  double timeToStandStill(double limit = 3.0);
  // How far the arm moves within `seconds`: the largest change of a joint, m or rad.
  double motionWithin(
      double seconds, const std::function<void()>& meanwhile = [] {});

  // Another process that commands a pan, rad/s, at `rate`, Hz, until it ends. Only in a test whose main is
  // runBenchTests().
  std::unique_ptr<ChildProcess> publisher(const std::string& name, double pan, double rate = 25.0);

  bool stateIs(const std::string& state) const { return state_ && state_->state == state; }
  bool isUp() const { return state_ && state_->is_homed; }

  // For the next start of the node. Whose commands count; this test's when empty.
  std::string master_;
  // Who may enable; everybody when empty.
  std::vector<std::string> service_callers_;
  // File to record to; none when empty.
  std::string wire_log_;

  std::optional<OperatingState> state_;
  std::optional<sensor_msgs::JointState> joints_;
  std::optional<geometry_msgs::PoseStamped> pose_;
  std::optional<geometry_msgs::TwistStamped> twist_;
  std::optional<diagnostic_msgs::DiagnosticStatus> diagnostics_;

 private:
  XmlRpc::XmlRpcValue overlay_;
  test_support::TemporaryFolder folder_;
  ros::NodeHandle node_handle_;
  std::unique_ptr<ChildProcess> emulator_;
  std::unique_ptr<ChildProcess> node_;
  std::unique_ptr<sim::EmulatorControlClient> truth_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher commands_;
};

// main() of a test with a bench; the same program is the other processes that the tests start.
int runBenchTests(int argc, char** argv, const std::string& name);

}  // namespace laparoscope_servo::test
