#include "system/aesop/aesop_bench.h"

#include <gtest/gtest.h>

#include <chrono>
#include <iostream>
#include <stdexcept>
#include <thread>

#include "ros/common/parameters.h"
#include "support/service_call.h"

namespace laparoscope_servo::test {

namespace {

constexpr double kCommandPeriod = 0.02;  // s

template <typename Message>
ros::Subscriber keepLast(ros::NodeHandle& node, const std::string& topic, std::optional<Message>& last) {
  return node.subscribe<Message>(topic, 10, [&last](const typename Message::ConstPtr& message) { last = *message; });
}

}  // namespace

AesopBench::AesopBench(bool with_node, const std::vector<std::string>& emulator_arguments) {
  const std::string control = folder_.file("control");
  std::vector<std::string> arguments{"--link", port(), "--control", control, "--baud", "38400"};
  arguments.insert(arguments.end(), emulator_arguments.begin(), emulator_arguments.end());
  emulator_ = std::make_unique<ChildProcess>(AESOP_EMULATOR, arguments);
  const double end = steadyNow() + 5.0;
  while (!truth_) {
    try {
      truth_ = std::make_unique<sim::EmulatorControlClient>(control, 2.0);
    } catch (const std::runtime_error&) {
      if (steadyNow() > end) throw;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  subscribers_ = {
      keepLast(node_handle_, "aesop/operating_state", state_), keepLast(node_handle_, "aesop/measured_js", joints_),
      keepLast(node_handle_, "aesop/measured_cp", pose_), keepLast(node_handle_, "aesop/measured_cv", twist_)};
  subscribers_.push_back(node_handle_.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10, [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& array) {
        for (const auto& status : array->status) {
          if (status.name.find("AESOP") != std::string::npos) diagnostics_ = status;
        }
      }));
  commands_ = node_handle_.advertise<ScopeVelocity>("servo_command", 1);
  if (with_node) startNode();
}

AesopBench::~AesopBench() {
  node_.reset();
  truth_.reset();
  if (emulator_->isRunning()) {
    emulator_->kill(SIGTERM);
    emulator_->exitStatus(2.0);
  }
  emulator_.reset();
}

void AesopBench::startNode(const std::string& program, const std::vector<std::string>& arguments,
                           const std::string& output) {
  XmlRpc::XmlRpcValue parameters = mergeParameters(parametersFromYaml(AESOP_CONFIG), overlay_);
  parameters["port"] = port();
  parameters["command"]["publisher"] = master_.empty() ? ros::this_node::getName() : master_;
  parameters["reconnect"]["longest_pause"] = 0.5;  // tests cut the line again and again
  XmlRpc::XmlRpcValue callers;
  callers.setSize(0);
  for (const std::string& caller : service_callers_) callers[callers.size()] = caller;
  parameters["service_callers"] = callers;
  parameters["wire_log"]["file"] = wire_log_;
  ros::param::set("/aesop", parameters);
  state_.reset();
  std::vector<std::string> all = arguments;
  all.push_back("__name:=aesop");
  node_ = std::make_unique<ChildProcess>(program, all, output);
  if (!waitFor([this] { return isUp() && commands_.getNumSubscribers() > 0; }, 10.0)) {
    throw std::runtime_error("the aesop node has not connected to the emulator");
  }
}

bool AesopBench::waitFor(const std::function<bool()>& condition, double seconds) {
  const double end = steadyNow() + seconds;
  ros::spinOnce();
  while (!condition()) {
    if (steadyNow() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ros::spinOnce();
  }
  return true;
}

bool AesopBench::commandUntil(const std::function<bool()>& condition, double pan, double seconds) {
  double next = 0.0;
  return waitFor(
      [&] {
        if (steadyNow() >= next) {
          next = steadyNow() + kCommandPeriod;
          send(pan, 0.0, ros::Time::now());
        }
        return condition();
      },
      seconds);
}

void AesopBench::send(double pan, double insertion, const ros::Time& stamp) {
  ScopeVelocity message;
  message.header.stamp = stamp;
  message.pan = pan;
  message.insertion = insertion;
  commands_.publish(message);
}

void AesopBench::send(ScopeVelocity command) {
  command.header.stamp = ros::Time::now();
  commands_.publish(command);
}

std_srvs::Trigger::Response AesopBench::call(const std::string& service) {
  std_srvs::Trigger trigger;
  if (!test_support::callWithin("aesop/" + service, trigger))
    throw std::runtime_error("service " + service + " is not there, or does not answer");
  ros::spinOnce();
  return trigger.response;
}

// On a busy machine the emulator may be silent for longer than the node bears, who refuses then, or disables again:
// then once more.
bool AesopBench::enable() {
  const double end = steadyNow() + 20.0;
  std::string why;
  do {
    const std_srvs::Trigger::Response answer = call("enable");
    if (answer.success && waitFor([this] { return stateIs("ENABLED"); }, 2.0)) return true;
    why = answer.success ? state_->reason : answer.message;
    std::cerr << "enable: " << why << "\n";
  } while (steadyNow() < end && (why.find("has not confirmed the enable") != std::string::npos ||
                                 why.find("has sent no status for") != std::string::npos));
  return false;
}

bool AesopBench::startMoving() {
  return enable() && commandUntil([this] { return jointsMove(); }, 0.05);
}

std::unique_ptr<ChildProcess> AesopBench::publisher(const std::string& name, double pan, double rate) {
  return std::make_unique<ChildProcess>(
      "/proc/self/exe", std::vector<std::string>{"publish", "__name:=" + name, "_pan:=" + std::to_string(pan),
                                                 "_rate:=" + std::to_string(rate)});
}

double AesopBench::timeToStandStill(double limit) {
  const double start = steadyNow();
  while (jointsMove() && steadyNow() - start < limit) std::this_thread::sleep_for(std::chrono::microseconds(500));
  return steadyNow() - start;
}

double AesopBench::motionWithin(double seconds, const std::function<void()>& meanwhile) {
  const aesop::JointVector before = truth_->state().q;
  double largest = 0.0;
  waitFor(
      [&] {
        meanwhile();
        largest = std::max(largest, (truth_->state().q - before).lpNorm<Eigen::Infinity>());
        return false;
      },
      seconds);
  return largest;
}

namespace {

int publish() {
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<ScopeVelocity>("servo_command", 1);
  const double pan = ros::param::param("~pan", 0.0);
  // As any node does. One that has never logged registers itself again when it is replaced, and ends its successor,
  // too.
  ROS_INFO_STREAM("commands a pan of " << pan << " rad/s");
  ros::WallRate rate(ros::param::param("~rate", 25.0));
  while (ros::ok()) {
    ScopeVelocity command;
    command.header.stamp = ros::Time::now();
    command.pan = pan;
    publisher.publish(command);
    rate.sleep();
  }
  return 0;
}

}  // namespace

int runBenchTests(int argc, char** argv, const std::string& name) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, name);
  if (argc > 1 && std::string(argv[1]) == "publish") return publish();
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}

}  // namespace laparoscope_servo::test
