#include "screen/ros_link.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <laparoscope_servo/PlaybackState.h>
#include <laparoscope_servo/ScopeVelocity.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/param.h>
#include <std_msgs/Empty.h>

#include <chrono>
#include <limits>
#include <optional>
#include <utility>

#include "ros/common/clocks.h"
#include "screen/listen.h"
#include "screen/recorder_status.h"

namespace laparoscope_servo::screen {

namespace {

constexpr std::chrono::milliseconds kMasterPause{300};  // between two checks for a master
constexpr std::chrono::milliseconds kTurn{100};         // between two checks of the connections
constexpr unsigned kMasterTurns = 10;                   // cycles between two questions to the master
constexpr unsigned kViewTurns = 30;                     // cycles between two queries of the stored views

// Age by the stamp; 0 with the clock of a recording, which may stand still.
double ageOf(const ros::Time& stamp) {
  return ros::Time::isSimTime() || stamp.isZero() ? 0.0 : (ros::Time::now() - stamp).toSec();
}

double delayOf(const ros::Time& stamp) {
  return ros::Time::isSimTime() || stamp.isZero() ? std::numeric_limits<double>::quiet_NaN() : ageOf(stamp);
}

// Velocities at the ends of the sliders; empty if the controller has none.
std::optional<Limits> limitsOf(const ros::NodeHandle& node) {
  static const char* const names[] = {"pan", "tilt", "spin", "insertion"};
  Limits limits{};
  for (std::size_t k = 0; k < limits.size(); ++k) {
    if (!node.getParam(std::string("controller/limits/velocity/") + names[k], limits[k])) return std::nullopt;
  }
  return limits;
}

// Forgets when a node was last heard, once another one has taken its place: the new node has not been silent since
// then.
template <class NodeFacts>
void setConnected(NodeFacts& node, bool connected, double now) {
  constexpr double kOfTheNewOne = 0.5;  // s: its first message may come before its connection is seen
  if (connected && !node.connected && now - node.heard_at > kOfTheNewOne) node.heard_at = kNever;
  node.connected = connected;
}

}  // namespace

RosLink::RosLink(const std::function<void()>& news, const std::string& space)
    : news_(news),
      space_(space),
      tracker_(
          keeper_, calls_, [this](const std::string& name) { return resolved(name); }, news),
      parameters_(keeper_, [this](const Answer& answer) { take(answer); }),
      calls_([this](const Answer& answer) { take(answer); }),
      thread_([this] { run(); }) {}

void RosLink::take(const Answer& answer) {
  keeper_.take(answer);
  news_();
}

RosLink::~RosLink() {
  dead_man_.letGo();
  slider_.letGo();
  ends_ = true;
  thread_.join();
  parameters_.disconnect();
  const std::lock_guard<std::mutex> lock(mutex_);
  connection_.reset();
}

// Waits for the master here, since a NodeHandle would wait for it for ever.
void RosLink::run() {
  while (!ends_ && !ros::master::check()) std::this_thread::sleep_for(kMasterPause);
  if (ends_) return;
  Registration registration;
  registration.renew(ends_);
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
    if (connection.turns % kMasterTurns == 0 && registration.renew(ends_)) renewed();
    look(connection);
    std::this_thread::sleep_for(kTurn);
  }
  listener.stop();
}

// The controller of the new master may have other limits. Whether time is simulated is fixed for the life of a process,
// so a change of it is reported.
void RosLink::renewed() {
  keeper_.change([](Facts& facts) { facts.limits.reset(); });
  bool recorded = false;
  ros::param::get("/use_sim_time", recorded);
  if (recorded == ros::Time::isSimTime())
    return take({"New ROS master", "It knows this screen again.", Outcome::kDone});
  take({"New ROS master", "Its time is another one (a recording's): start the screen anew.", Outcome::kRefused});
}

std::unique_ptr<RosLink::Connection> RosLink::connect() {
  auto made = std::make_unique<Connection>(space_);
  ros::NodeHandle& node = made->node;
  node.setCallbackQueue(&queue_);
  made->robot_stop = node.advertise<std_msgs::Empty>("aesop/stop", 10);
  made->controller_stop = node.advertise<std_msgs::Empty>("controller/stop", 10);
  made->sender = std::make_unique<HoldSender>(node, dead_man_, slider_);
  // Queue of one: only the newest picture is shown.
  made->preview = listen<sensor_msgs::Image>(node, "tracker/preview", 1, [this](const sensor_msgs::Image& image) {
    keeper_.take(image, ageOf(image.header.stamp), steadyNow());
    news_();
  });
  made->homography = listen<Homography>(node, "tracker/homography", 100, [this](const Homography& message) {
    keeper_.take(message, delayOf(message.header.stamp), steadyNow());
  });
  made->recorded = listen<Homography>(node, "recorded/tracker/homography", 100,
                                      [this](const Homography& message) { keeper_.takeRecorded(message); });
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
  made->playback = listen<PlaybackState>(node, "player/state", 5, [this](const PlaybackState& message) {
    keeper_.change([&](Facts& facts) {
      facts.playback.state = message.state;
      facts.playback.reason = message.reason;
      facts.playback.position = message.position;
      facts.playback.duration = message.duration;
      facts.playback.period = message.period;
    });
    news_();
  });
  made->diagnostics = listen<diagnostic_msgs::DiagnosticArray>(
      node, "/diagnostics", 50, [this, space = node.getNamespace()](const diagnostic_msgs::DiagnosticArray& message) {
        std::optional<RecorderFacts> recorder = recorderIn(message, space);
        if (!recorder) return;
        recorder->heard_at = steadyNow();
        keeper_.change([&](Facts& facts) { facts.recorder = *recorder; });
      });
  made->features =
      std::make_unique<FeatureLink>(node, [this](const std::string& tracker, const TrackedFeatures& message) {
        if (keeper_.take(tracker, message, steadyNow())) news_();
      });
  parameters_.connect(node);
  return made;
}

void RosLink::look(Connection& connection) {
  const bool tracker = connection.tracker_state.getNumPublishers() > 0;
  const bool controller = connection.controller_state.getNumPublishers() > 0;
  const bool robot = connection.operating_state.getNumPublishers() > 0;
  const bool playback = connection.playback.getNumPublishers() > 0;
  const bool dead_man = connection.sender->isDeadManWanted();
  const double now = steadyNow();
  keeper_.change([&](Facts& facts) {
    setConnected(facts.tracker, tracker, now);
    if (facts.tracker.heard_at < 0.0) facts.tracker.result_at = kNever;
    setConnected(facts.controller, controller, now);
    setConnected(facts.robot, robot, now);
    facts.dead_man_wanted = dead_man;
    facts.playback.connected = playback;
  });
  if (connection.turns % kMasterTurns == 0) connection.features->find();
  const FeatureLink::Connected features = connection.features->connected();
  keeper_.setFeatureTrackers(features);
  choosePicture(connection, tracker, features);
  ++connection.turns;
  if (tracker && connection.turns % kViewTurns == 1) tracker_.listViews();
  if (!tracker) tracker_.forget();
  // The limits cannot change while the controller runs, but may differ after its restart.
  if (!controller) connection.limits_wanted = true;
  if (!controller || !connection.limits_wanted) return;
  const std::optional<Limits> limits = limitsOf(connection.node);
  if (!limits) return;
  connection.limits_wanted = false;
  double max_age = kNever;
  connection.node.getParam("controller/safety/max_task_error_age", max_age);
  connection.sender->setLimits(*limits);
  keeper_.change([&](Facts& facts) { facts.limits = limits, facts.max_image_age = max_age; });
}

// That of the region tracker; where none runs, that of a tracker of features.
void RosLink::choosePicture(Connection& connection, bool tracker, const FeatureLink::Connected& features) {
  std::string wanted;
  for (const auto& [name, connected] : features) {
    if (!tracker && connected && wanted.empty()) wanted = name;
  }
  if (wanted == connection.features_shown) return;
  connection.features_shown = wanted;
  connection.features_preview.shutdown();
  if (wanted.empty()) return;
  connection.features_preview = listen<sensor_msgs::Image>(
      connection.node, wanted + "/preview", 1, [this, wanted](const sensor_msgs::Image& image) {
        keeper_.take(wanted, image, ageOf(image.header.stamp), steadyNow());
        news_();
      });
}

std::string RosLink::resolved(const std::string& name) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return connection_ ? connection_->node.resolveName(name) : "";
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
