#include "ros/controller/controller_inputs.h"

#include <algorithm>
#include <cmath>

#include "ros/common/clocks.h"
#include "ros/controller/controller_conversions.h"

namespace laparoscope_servo {

namespace {

// Messages of one topic. Only the owner's newest one counts, but those of others must not push it out of the queue: 0.1
// s of another publisher that floods the topic at 10 kHz.
constexpr std::uint32_t kQueue = 1000;
constexpr double kWarningPeriod = 5.0;  // s
// s; an older measured velocity cannot be related to the commands any more
constexpr double kOldestReport = 0.3;

std::string resolved(const ros::NodeHandle& node, const std::string& name) {
  return name.empty() ? name : node.resolveName(name, false);
}

// Age by the stamp [s]; 0 without a stamp.
double stampAge(const ros::Time& stamp) {
  return stamp.isZero() ? 0.0 : (ros::Time::now() - stamp).toSec();
}

// A state from the network, made safe for display.
std::string shownState(const std::string& state) {
  for (const char* known : {"DISABLED", "FAULT"}) {
    if (state == known) return state;
  }
  return "none that is known";
}

std::string inFuture(const std::string& what) {
  return what + " is stamped in the future, compare the clocks of the machines";
}

}  // namespace

ControllerInputs::ControllerInputs(ros::NodeHandle& node, ros::NodeHandle& private_node,
                                   const ControllerNodeConfig& config, const Calls& calls)
    : config_(config),
      calls_(calls),
      task_error_input_(resolved(node, config.owners.task_error), "task errors", "owners/task_error",
                        config.control.safety.max_clock_difference),
      homography_input_(resolved(node, config.owners.task_error), "homographies", "owners/task_error",
                        config.control.safety.max_clock_difference),
      motion_input_(resolved(node, config.owners.motion), "motion features", "owners/motion",
                    config.control.safety.max_clock_difference),
      instrument_input_(resolved(node, config.owners.instrument), "instruments", "owners/instrument",
                        config.control.safety.max_clock_difference),
      points_input_(resolved(node, config.owners.points), "points", "owners/points",
                    config.control.safety.max_clock_difference),
      camera_info_input_(resolved(node, config.owners.camera_info), "camera infos", "owners/camera_info",
                         config.control.safety.max_clock_difference),
      operating_state_input_(resolved(node, config.owners.operating_state), "operating states",
                             "owners/operating_state", config.control.safety.max_clock_difference),
      measured_velocity_input_(resolved(node, config.owners.operating_state), "measured velocities",
                               "owners/operating_state", config.control.safety.max_clock_difference),
      manual_input_(resolved(node, config.owners.manual), "manual commands", "owners/manual",
                    config.control.safety.max_clock_difference),
      dead_man_input_(resolved(node, config.owners.dead_man), "words of the dead-man switch", "owners/dead_man",
                      config.control.safety.max_clock_difference),
      camera_(config.rectified_images),
      object_place_(config.control.follow),
      points_error_(config.control.points, config.control.features.desired_depth),
      position_input_(config.control.features.desired_depth),
      tip_input_(config.control.centre_tip),
      dead_man_(config.control.safety.max_dead_man_age) {
  // tcpNoDelay: a message must not wait for a full packet.
  const ros::TransportHints at_once = ros::TransportHints().tcpNoDelay();
  using Self = ControllerInputs;
  task_error_input_.subscriber = node.subscribe("task_error", kQueue, &Self::onTaskError, this, at_once);
  homography_input_.subscriber = node.subscribe("homography", kQueue, &Self::onHomography, this, at_once);
  motion_input_.subscriber = node.subscribe("motion_features", kQueue, &Self::onMotion, this, at_once);
  instrument_input_.subscriber = node.subscribe("instrument_features", kQueue, &Self::onInstrument, this, at_once);
  points_input_.subscriber = node.subscribe("points_features", kQueue, &Self::onPoints, this, at_once);
  camera_info_input_.subscriber = node.subscribe("camera_info", kQueue, &Self::onCameraInfo, this, at_once);
  manual_input_.subscriber = private_node.subscribe("manual", kQueue, &Self::onManual, this, at_once);
  if (config_.control.safety.robot_required) {
    operating_state_input_.subscriber =
        node.subscribe("operating_state", kQueue, &Self::onOperatingState, this, at_once);
  }
  if (config_.control.safety.dead_man_required) {
    dead_man_input_.subscriber = node.subscribe("dead_man", kQueue, &Self::onDeadMan, this, at_once);
  }
  if (config_.control.predictor.measure_delay) {
    measured_velocity_input_.subscriber =
        node.subscribe("measured_cv", kQueue, &Self::onMeasuredVelocity, this, at_once);
  }
  stop_subscriber_ = private_node.subscribe("stop", 1, &Self::onStop, this, at_once);
}

void ControllerInputs::know(bool engaged, servo::Task task) {
  engaged_ = engaged;
  task_ = task;
  // Releases the ownership when the owner has been silent for max_manual_age.
  const bool silent = !(steadyNow() - manual_arrival_ <= config_.control.safety.max_manual_age);
  if (silent && !manualMatters()) manual_input_.owner.release();
}

void ControllerInputs::forgetStamps() {
  task_error_.forget();
  task_error_input_.stamps.clear();
  view_.forget();
  motion_input_.stamps.clear();
  tip_.forget();
  instrument_input_.stamps.clear();
  object_.forget();
  points_.forget();
  points_input_.stamps.clear();
  position_.forget();
  homography_input_.stamps.clear();
}

void ControllerInputs::end(const std::string& why) {
  if (engaged_) ended_ = why;
}

// `matters`: the input can move the arm now. If it cannot, ownership is released, so that the publisher of the last
// message is accepted.
bool ControllerInputs::counts(Input& input, const std::string& publisher, const InputOwner::Connection& connection,
                              bool matters) {
  if (!matters) input.owner.release();
  const double now = steadyNow();
  switch (input.owner.judge(publisher, connection, now)) {
    case InputOwner::Verdict::kOwner:
      return true;
    case InputOwner::Verdict::kNewConnection:
      // The publisher was restarted, replaced by another process of its name, or joined by one.
      end("the node of the " + input.owner.what() + ", " + shownName(publisher) + ", has connected anew");
      return false;
    case InputOwner::Verdict::kStranger:
      break;
  }
  if (now >= input.next_complaint) {
    input.next_complaint = now + kWarningPeriod;
    ROS_WARN_STREAM(input.owner.complaint(now));
  }
  return false;
}

// For inputs whose order does not matter.
bool ControllerInputs::isAhead(Input& input, const ros::Time& stamp) const {
  calls_.check_time();
  return input.stamps.isAhead(stamp, ros::Time::now());
}

// A stop is accepted with any stamp.
void ControllerInputs::onOperatingState(const ros::MessageEvent<OperatingState const>& event) {
  if (!counts(operating_state_input_, event, engaged_)) return;
  const OperatingState& message = *event.getConstMessage();
  const servo::RobotFacts robot = fromMessage(message);
  const bool stopped = !robot.enabled && !robot.paused;
  if (!stopped && isAhead(operating_state_input_, message.header.stamp)) return;
  if (stopped) end("the robot is not enabled: its state is " + shownState(message.state));
  robot_ = robot;
  robot_stamp_ = message.header.stamp;
  robot_arrival_ = steadyNow();
  if (engaged_ && stopped) calls_.step();
}

void ControllerInputs::onDeadMan(const ros::MessageEvent<std_msgs::Bool const>& event) {
  const InputOwner::Connection connection = event.getConnectionHeaderPtr();
  // Without a configured owner each connection may press, once it was seen released.
  const bool may_press = dead_man_input_.owner.name().empty() || counts(dead_man_input_, event, engaged_);
  const double now = steadyNow();
  const bool pressed = dead_man_.facts(now).pressed;
  dead_man_.said({connection.get(), [connection](const void*) {}}, event.getConstMessage()->data != 0, may_press, now);
  if (engaged_ && pressed && !dead_man_.facts(now).pressed) calls_.step();
}

// Sliders and command lines set no stamp. If there is one, it shows a delay on the way.
void ControllerInputs::onManual(const ros::MessageEvent<ScopeVelocity const>& event) {
  if (!counts(manual_input_, event, manualMatters())) return;
  const ScopeVelocity& message = *event.getConstMessage();
  if (isAhead(manual_input_, message.header.stamp)) return;
  manual_ = message;
  manual_arrival_ = steadyNow();
  if (!servoVelocity(message).vector().allFinite()) {
    ROS_WARN_STREAM_THROTTLE(kWarningPeriod, "The manual command counts as zero: pan "
                                                 << message.pan << ", tilt " << message.tilt << ", spin "
                                                 << message.spin << ", insertion " << message.insertion
                                                 << ", expected finite numbers.");
  }
}

// Only used to measure the delay, so invalid messages are ignored.
void ControllerInputs::onMeasuredVelocity(const ros::MessageEvent<geometry_msgs::TwistStamped const>& event) {
  if (!counts(measured_velocity_input_, event, engaged_)) return;
  const geometry_msgs::TwistStamped& message = *event.getConstMessage();
  if (message.header.stamp.isZero() || isAhead(measured_velocity_input_, message.header.stamp)) return;
  const double age = stampAge(message.header.stamp);
  if (!(age < kOldestReport)) return;
  const std::optional<Eigen::Quaterniond> shaft_R_frame = calls_.shaft_from(message.header.frame_id);
  if (!shaft_R_frame) return;
  robot_report_.velocity = fromTwist(message.twist, *shaft_R_frame);
  robot_report_.present = true;
  robot_report_arrival_ = steadyNow() - age;
}

// Accepted from every node, and works without a master over an open connection.
void ControllerInputs::onStop(const ros::MessageEvent<std_msgs::Empty const>& event) {
  calls_.stop(shownName(event.getPublisherName()));
}

void ControllerInputs::fill(servo::ControllerInput& input, double steady_now) const {
  input.ended = ended_;
  if (input.clock_jump.empty()) input.clock_jump = clock_jump_;
  input.robot = robot_;
  input.robot.age = std::max(steady_now - robot_arrival_, stampAge(robot_stamp_));
  const servo::SafetyConfig& safety = config_.control.safety;
  if (!(input.robot.age <= safety.max_robot_state_age) && operating_state_input_.stamps.onlyAhead()) {
    input.robot.problem = inFuture("the robot's operating state");
  }
  input.dead_man = dead_man_.facts(steady_now);
  input.manual.velocity = servoVelocity(manual_);
  input.manual.age = std::max(steady_now - manual_arrival_, stampAge(manual_.header.stamp));
  input.task_error = agedOf(task_error_input_, task_error_, steady_now);
  input.view = agedOf(motion_input_, view_, steady_now);
  input.tip = agedOf(instrument_input_, tip_, steady_now);
  input.object = agedOf(motion_input_, object_, steady_now);
  input.points = agedOf(points_input_, points_, steady_now);
  input.position = agedOf(homography_input_, position_, steady_now);
  if (isDenied(position_, task_error_)) input.position.valid = false;
  input.robot_report = robot_report_;
  input.robot_report.age = steady_now - robot_report_arrival_;
}

servo::TaskErrorInput ControllerInputs::agedOf(const Input& input, const Picture& picture, double steady_now) {
  servo::TaskErrorInput seen = picture.last;
  const bool came = !picture.watch.empty();
  if (came) seen.age = picture.watch.silence(steady_now);
  if (came) seen.image_age = picture.watch.stampAge(ros::Time::now());
  if (input.stamps.onlyAhead()) seen.problem = inFuture(picture.words.name);
  if (input.stamps.onlyUnset()) seen.problem = picture.words.without_stamp;
  return seen;
}

void ControllerInputs::taken() {
  ended_.clear();
  clock_jump_.clear();
  robot_report_.present = false;
}

void ControllerInputs::describe(diagnostic_updater::DiagnosticStatusWrapper& status) {
  for (Input* input :
       {&task_error_input_, &homography_input_, &motion_input_, &instrument_input_, &points_input_, &camera_info_input_,
        &operating_state_input_, &measured_velocity_input_, &manual_input_, &dead_man_input_}) {
    if (input->subscriber) describe(*input, status);
  }
  for (const Input* input :
       {&task_error_input_, &homography_input_, &motion_input_, &instrument_input_, &points_input_}) {
    const StampGate& stamps = input->stamps;
    status.add(input->owner.what() + ": stamps late", stamps.late());
    status.add(input->owner.what() + ": stamps repeated", stamps.repeated());
    status.add(input->owner.what() + ": without a stamp", stamps.unset());
  }
}

void ControllerInputs::describe(Input& input, diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const InputOwner& owner = input.owner;
  const std::uint32_t publishers = input.subscriber.getNumPublishers();
  const std::string whose = owner.name().empty() ? "whoever speaks first" : owner.name();
  const std::string complaint = owner.complaint(steadyNow());
  const std::string several = std::to_string(publishers) + " publishers of " + owner.what() + " are connected (" +
                              whose + " counts; 'rostopic info " + input.subscriber.getTopic() + "' names them)";
  if (!complaint.empty()) {
    status.mergeSummary(DiagnosticStatus::WARN, complaint);
  } else if (publishers > 1) {
    status.mergeSummary(DiagnosticStatus::WARN, several);
  }
  if (publishers > 1 && !input.several) ROS_WARN_STREAM(several);
  input.several = publishers > 1;
  status.add(owner.what() + ": owner", whose);
  status.add(owner.what() + ": publishers", publishers);
  status.add(owner.what() + ": refused for their sender", owner.refused());
  status.add(owner.what() + ": stamps ahead of time", input.stamps.ahead());
}

}  // namespace laparoscope_servo
