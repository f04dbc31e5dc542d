#include "screen/ros_link.h"

#include <laparoscope_servo/ScopeVelocity.h>
#include <laparoscope_servo/SelectRoi.h>
#include <laparoscope_servo/SelectTask.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/master.h>
#include <std_msgs/Empty.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <chrono>
#include <exception>
#include <optional>
#include <utility>

#include "ros/common/clocks.h"

namespace laparoscope_servo::screen {

namespace {

constexpr std::chrono::milliseconds kMasterPause{300};  // between two looks for a master
constexpr std::chrono::milliseconds kTurn{100};         // between two looks at the connections

// By its stamp; 0 where the clock is that of a recording, which may stand still.
double ageOf(const ros::Time& stamp) {
  return ros::Time::isSimTime() || stamp.isZero() ? 0.0 : (ros::Time::now() - stamp).toSec();
}

// Nothing that a topic carries may end the screen.
template <class Message, class Take>
ros::Subscriber listen(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue, const Take& take) {
  const auto callback = [take](const boost::shared_ptr<const Message>& message) {
    try {
      take(*message);
    } catch (const std::exception& error) {
      ROS_WARN_STREAM_THROTTLE(5.0, "a message cannot be shown: " << error.what());
    }
  };
  return node.subscribe<Message>(topic, queue, callback, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
}

// What the sliders' ends stand for; empty where the controller has none.
std::optional<Limits> limitsOf(const ros::NodeHandle& node) {
  static const char* const names[] = {"pan", "tilt", "spin", "insertion"};
  Limits limits{};
  for (std::size_t k = 0; k < limits.size(); ++k) {
    if (!node.getParam(std::string("controller/limits/velocity/") + names[k], limits[k])) return std::nullopt;
  }
  return limits;
}

}  // namespace

RosLink::RosLink(const std::function<void()>& news)
    : news_(news),
      calls_([this](const Answer& answer) {
        keeper_.take(answer);
        news_();
      }),
      thread_([this] { run(); }) {}

RosLink::~RosLink() {
  dead_man_.letGo();
  slider_.letGo();
  ends_ = true;
  thread_.join();
  const std::lock_guard<std::mutex> lock(mutex_);
  connection_.reset();
}

// A NodeHandle would wait for the master for ever.
void RosLink::run() {
  while (!ends_ && !ros::master::check()) std::this_thread::sleep_for(kMasterPause);
  if (ends_) return;
  std::unique_ptr<Connection> made = connect();
  Connection& connection = *made;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    connection_ = std::move(made);
  }
  keeper_.change([](Facts& facts) { facts.master = true; });
  ros::AsyncSpinner listener(1, &queue_);
  listener.start();
  while (!ends_ && ros::ok()) {
    look(connection);
    std::this_thread::sleep_for(kTurn);
  }
  listener.stop();
}

std::unique_ptr<RosLink::Connection> RosLink::connect() {
  auto made = std::make_unique<Connection>();
  ros::NodeHandle& node = made->node;
  node.setCallbackQueue(&queue_);
  made->robot_stop = node.advertise<std_msgs::Empty>("aesop/stop", 10);
  made->controller_stop = node.advertise<std_msgs::Empty>("controller/stop", 10);
  made->sender = std::make_unique<HoldSender>(node, dead_man_, slider_);
  // The newest picture is the one to show.
  made->preview = listen<sensor_msgs::Image>(node, "tracker/preview", 1, [this](const sensor_msgs::Image& image) {
    keeper_.take(image, ageOf(image.header.stamp), steadyNow());
    news_();
  });
  made->homography =
      listen<Homography>(node, "tracker/homography", 100, [this](const Homography& message) { keeper_.take(message); });
  made->areas = listen<AreaSelection>(node, "tracker/areas", 100,
                                      [this](const AreaSelection& message) { keeper_.take(message); });
  made->tracker_state = listen<TrackerState>(
      node, "tracker/state", 10, [this](const TrackerState& message) { keeper_.take(message, steadyNow()); });
  made->controller_state = listen<ControllerState>(node, "controller/state", 10,
                                                   [this](const ControllerState& message) { keeper_.take(message); });
  made->command = listen<ScopeVelocity>(node, "servo_command", 10,
                                        [this](const ScopeVelocity&) { keeper_.takeCommand(steadyNow()); });
  made->operating_state = listen<OperatingState>(
      node, "aesop/operating_state", 10, [this](const OperatingState& message) { keeper_.take(message, steadyNow()); });
  return made;
}

void RosLink::look(Connection& connection) {
  const bool tracker = connection.tracker_state.getNumPublishers() > 0;
  const bool controller = connection.controller_state.getNumPublishers() > 0;
  const bool robot = connection.operating_state.getNumPublishers() > 0;
  const bool dead_man = connection.sender->isDeadManWanted();
  keeper_.change([&](Facts& facts) {
    facts.tracker.connected = tracker;
    facts.controller.connected = controller;
    facts.robot.connected = robot;
    facts.dead_man_wanted = dead_man;
  });
  // They cannot change while it runs; the next one may have others.
  if (!controller) connection.limits_wanted = true;
  if (!controller || !connection.limits_wanted) return;
  const std::optional<Limits> limits = limitsOf(connection.node);
  if (!limits) return;
  connection.limits_wanted = false;
  connection.sender->setLimits(*limits);
  keeper_.change([&](Facts& facts) { facts.limits = limits; });
}

void RosLink::stop() {
  dead_man_.letGo();
  slider_.letGo();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!connection_) return;
  connection_->robot_stop.publish(std_msgs::Empty());
  connection_->controller_stop.publish(std_msgs::Empty());
  connection_->sender->wake();
  std_srvs::SetBool disengage;
  disengage.request.data = 0;
  calls_.call(connection_->node.resolveName("controller/engage"), "STOP, disengage", disengage);
  calls_.call(connection_->node.resolveName("aesop/disable"), "STOP, disable", std_srvs::Trigger());
}

std::string RosLink::resolved(const std::string& name) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return connection_ ? connection_->node.resolveName(name) : "";
}

void RosLink::trigger(const std::string& service, const std::string& what) {
  const std::string name = resolved(service);
  if (!name.empty()) calls_.call(name, what, std_srvs::Trigger());
}

void RosLink::engage(bool on) {
  std_srvs::SetBool request;
  request.request.data = static_cast<std::uint8_t>(on);
  const std::string name = resolved("controller/engage");
  if (!name.empty()) calls_.call(name, on ? "Engage" : "Disengage", request);
}

void RosLink::selectTask(const std::string& task) {
  SelectTask request;
  request.request.task = task;
  const std::string name = resolved("controller/select_task");
  if (!name.empty()) calls_.call(name, "Task", request);
}

void RosLink::selectRegion(const QRect& pixels) {
  SelectRoi request;
  request.request.roi.x_offset = static_cast<std::uint32_t>(pixels.x());
  request.request.roi.y_offset = static_cast<std::uint32_t>(pixels.y());
  request.request.roi.width = static_cast<std::uint32_t>(pixels.width());
  request.request.roi.height = static_cast<std::uint32_t>(pixels.height());
  const std::string name = resolved("tracker/select_roi");
  if (!name.empty()) calls_.call(name, "Region", request);
}

void RosLink::setShares(const std::array<double, 4>& shares) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (connection_) connection_->sender->setShares(shares);
}

void RosLink::said() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (connection_) connection_->sender->wake();
}

}  // namespace laparoscope_servo::screen
