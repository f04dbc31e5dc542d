#include "laparoscope_servo/ros/controller_node.h"

#include <laparoscope_servo/ControllerState.h>
#include <laparoscope_servo/ScopeVelocity.h>

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/ros/clocks.h"
#include "laparoscope_servo/ros/controller_conversions.h"

namespace laparoscope_servo::skin {

namespace {

// s. A correction of the machine's clock by less is no jump.
constexpr double kClockCorrection = 0.1;

constexpr double kWarningPeriod = 5.0;  // s
// s. A velocity that was measured so long before, or after, has no place among the commands.
constexpr double kOldestReport = 0.3;

const char* doing(servo::Task task) {
  return task == servo::Task::kManual ? "is driven by hand" : "follows the region of interest";
}

}  // namespace

ControllerNode::ControllerNode(ros::NodeHandle node, ros::NodeHandle private_node, const ControllerNodeConfig& config)
    : config_(config),
      controller_(config.control),
      stops_(config.external_stops),
      future_transforms_(config.control.safety.max_depth_age),
      last_now_(ros::Time::now()),
      tf_listener_(tf_),
      diagnostics_(node, private_node),
      command_publisher_(node.advertise<ScopeVelocity>("servo_command", 1)),
      state_publisher_(private_node.advertise<ControllerState>("state", 1, true)) {
  diagnostics_.setHardwareID("none");
  diagnostics_.add("control", this, &ControllerNode::report);
  publish(controller_.update(input()));
  // Only the newest message counts, and it must not wait for a full packet.
  const ros::TransportHints at_once = ros::TransportHints().tcpNoDelay();
  task_error_subscriber_ = node.subscribe("task_error", 1, &ControllerNode::onTaskError, this, at_once);
  if (config_.control.safety.robot_required) {
    operating_state_subscriber_ =
        node.subscribe("operating_state", 1, &ControllerNode::onOperatingState, this, at_once);
  }
  if (config_.control.safety.dead_man_required) {
    dead_man_subscriber_ = node.subscribe("dead_man", 1, &ControllerNode::onDeadMan, this, at_once);
  }
  manual_subscriber_ = private_node.subscribe("manual", 1, &ControllerNode::onManual, this, at_once);
  select_task_service_ = private_node.advertiseService("select_task", &ControllerNode::onSelectTask, this);
  if (config_.control.predictor.measure_delay) {
    measured_velocity_subscriber_ =
        node.subscribe("measured_cv", 1, &ControllerNode::onMeasuredVelocity, this, at_once);
  }
  engage_service_ = private_node.advertiseService("engage", &ControllerNode::onEngage, this);
  tick_timer_ =
      node.createSteadyTimer(ros::WallDuration(1.0 / config_.rate), [this](const ros::SteadyTimerEvent&) { onTick(); });
  // Not Updater::update(): it waits for ROS time, which may have jumped back.
  diagnostics_timer_ = node.createSteadyTimer(ros::WallDuration(diagnostics_.getPeriod()),
                                              [this](const ros::SteadyTimerEvent&) { diagnostics_.force_update(); });
}

void ControllerNode::stop() {
  controller_.disengage("the controller ends");
  publish(controller_.update(input()));
}

void ControllerNode::onTaskError(const TaskError& message) {
  checkTime();
  const StampWatch::Arrival arrival = task_error_watch_.arrived(message.header.stamp, steadyNow());
  if (arrival == StampWatch::Arrival::kRepeated) return;
  const bool counts = controller_.task() == servo::Task::kHoldView;
  if (arrival == StampWatch::Arrival::kBack && counts) clock_jump_ = "stamps of the task error jumped back";
  task_error_ = fromMessage(message);
  // Once for each image: the two clocks need not agree on it later.
  task_error_.image_time = steadyNow() - task_error_watch_.stampAge(ros::Time::now());
}

// A message without a stamp counts from when it came: whoever sends it repeats it.
void ControllerNode::onOperatingState(const OperatingState& message) {
  robot_ = fromMessage(message);
  robot_arrival_ = steadyNow();
}

void ControllerNode::onDeadMan(const std_msgs::Bool& message) {
  dead_man_.pressed = message.data != 0;
  dead_man_arrival_ = steadyNow();
}

void ControllerNode::onManual(const ScopeVelocity& message) {
  manual_ = message;
  manual_arrival_ = steadyNow();
  if (!servoVelocity(message).vector().allFinite()) {
    ROS_WARN_STREAM_THROTTLE(kWarningPeriod, "The manual command counts as zero: pan "
                                                 << message.pan << ", tilt " << message.tilt << ", spin "
                                                 << message.spin << ", insertion " << message.insertion
                                                 << ", expected finite numbers.");
  }
}

// Only the delay is measured with it: what is missing or wrong here is left out.
void ControllerNode::onMeasuredVelocity(const geometry_msgs::TwistStamped& message) {
  const double age = (ros::Time::now() - message.header.stamp).toSec();
  if (message.header.stamp.isZero() || !(age > -kClockCorrection && age < kOldestReport)) return;
  try {
    const auto rotation = tf_.lookupTransform(config_.shaft, message.header.frame_id, ros::Time(0)).transform.rotation;
    robot_report_.velocity =
        fromTwist(message.twist, Eigen::Quaterniond(rotation.w, rotation.x, rotation.y, rotation.z).normalized());
  } catch (const tf2::TransformException&) {
    return;
  }
  robot_report_.present = true;
  robot_report_arrival_ = steadyNow() - age;
}

void ControllerNode::watchOutside() {
  const double now = steadyNow();
  std::string stop = stops_.takeStop(now);
  if (stop.empty()) stop = stops_.obstacle(now);
  if (!stop.empty() && controller_.engaged()) controller_.disengage(stop);
}

void ControllerNode::onTick() {
  checkTime();
  watchOutside();
  last_input_ = input();
  clock_jump_.clear();
  publish(controller_.update(last_input_));
}

// A looped bag, a restarted simulation: nothing that was known holds, and nobody expects the arm to go on.
void ControllerNode::checkTime() {
  const ros::Time now = ros::Time::now();
  const bool back = (last_now_ - now).toSec() > kClockCorrection;
  last_now_ = now;
  if (!back) return;
  task_error_ = servo::TaskErrorInput();
  task_error_watch_.clear();
  depth_watch_.clear();
  tf_.clear();
  clock_jump_ = "ROS time jumped back";
}

servo::ControllerInput ControllerNode::input() {
  const double steady_now = steadyNow();
  servo::ControllerInput input;
  input.time = steady_now;
  // Poses are counted in this frame, and d2 from it.
  if (insertion_point_watch_.moved(tf_, config_.insertion_point)) clock_jump_ = "the insertion point is another one";
  input.clock_jump = clock_jump_;
  input.robot = robot_;
  input.robot.age = steady_now - robot_arrival_;
  input.dead_man = dead_man_;
  input.dead_man.age = steady_now - dead_man_arrival_;
  input.manual.velocity = servoVelocity(manual_);
  input.manual.age = steady_now - manual_arrival_;
  // Sliders and command lines set no stamp. One that is set tells what waited on its way.
  if (!manual_.header.stamp.isZero()) {
    input.manual.age = std::max(input.manual.age, (ros::Time::now() - manual_.header.stamp).toSec());
  }
  input.task_error = task_error_;
  if (!task_error_watch_.empty()) {
    const ros::Time now = ros::Time::now();
    input.task_error.age = task_error_watch_.silence(steady_now);
    input.task_error.image_age = task_error_watch_.stampAge(now);
    if (task_error_watch_.isAhead(now, config_.control.safety.max_task_error_age)) {
      input.task_error.problem = "task error is stamped in the future, compare the clocks of the machines";
    }
  }
  input.depth = depth(steady_now);
  input.robot_report = robot_report_;
  input.robot_report.age = steady_now - robot_report_arrival_;
  robot_report_.present = false;
  return input;
}

servo::DepthInput ControllerNode::depth(double steady_now) {
  servo::DepthInput depth;
  const ros::Time now = ros::Time::now();
  if (future_transforms_.found(tf_, config_.camera, config_.insertion_point, now, steady_now)) {
    depth.problem = "tf is stamped in the future, compare the clocks of the machines";
    return depth;
  }
  try {
    const auto transform = tf_.lookupTransform(config_.camera, config_.insertion_point, ros::Time(0));
    depth =
        fromTransforms(transform.transform, tf_.lookupTransform(config_.camera, config_.shaft, ros::Time(0)).transform);
    if (!depth.problem.empty()) return depth;
    if (transform.header.stamp.isZero()) {
      // d2 changes when the scope is inserted: a transform that cannot change says nothing about the arm.
      depth.problem =
          "tf from " + config_.camera + " to " + config_.insertion_point + " is static, expected the robot's";
      return depth;
    }
    depth.pose_is_new = depth_watch_.arrived(transform.header.stamp, steady_now) != StampWatch::Arrival::kRepeated;
    depth.age = depth_watch_.age(now, steady_now);
  } catch (const tf2::ExtrapolationException&) {  // its text holds times, which change with every step
    depth.problem = "tf from " + config_.camera + " to " + config_.insertion_point + " has no common time";
  } catch (const tf2::TransformException& error) {
    depth.problem = std::string("depth d2 is unknown: ") + error.what();
  }
  return depth;
}

void ControllerNode::publish(const servo::ControllerOutput& output) {
  ScopeVelocity command = toMessage(output.command);
  command.header.stamp = ros::Time::now();
  command.header.frame_id = config_.shaft;
  command_publisher_.publish(command);
  const bool changed =
      output.state != last_output_.state || output.reason != last_output_.reason || output.task != last_output_.task;
  const servo::ControllerState before = last_output_.state;
  last_output_ = output;
  if (!changed && state_published_) return;
  publishState(output);
  if (output.state == servo::ControllerState::kServo) {
    ROS_INFO("The scope %s.", doing(output.task));
  } else if (output.state == servo::ControllerState::kFault) {
    ROS_ERROR("The scope stands still: %s.", output.reason.c_str());
  } else if (before != servo::ControllerState::kIdle || output.engaged()) {
    ROS_WARN("The scope stands still: %s.", output.reason.c_str());
  }
}

void ControllerNode::publishState(const servo::ControllerOutput& output) {
  ControllerState state = toMessage(output);
  state.header.stamp = ros::Time::now();
  state_publisher_.publish(state);
  state_published_ = true;
}

void ControllerNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  using State = servo::ControllerState;
  const ControllerState state = toMessage(last_output_);
  const std::string& caution = last_output_.caution;
  if (last_output_.state == State::kServo) {
    status.summary(caution.empty() ? DiagnosticStatus::OK : DiagnosticStatus::WARN,
                   doing(last_output_.task) + (caution.empty() ? "" : ", " + caution));
  } else {
    const bool is_bad = last_output_.state == State::kHold || last_output_.state == State::kLost;
    status.summary(is_bad ? DiagnosticStatus::WARN : DiagnosticStatus::OK, state.state + ": " + state.reason);
    if (last_output_.state == State::kFault) status.level = DiagnosticStatus::ERROR;
  }
  status.add("task", state.task);
  status.add("state", state.state);
  status.add("reason", state.reason);
  status.add("speed scale", last_output_.speed_scale);
  const std::string problem = controller_.problem(last_input_);
  stops_.describe(steadyNow(), status);
  status.add("ready to move", problem.empty() ? "yes" : "no: " + problem);
  status.add("age of the task error [s]", last_input_.task_error.age);
  status.add("age of its image [s]", last_input_.task_error.image_age);
  status.add("visible fraction", last_input_.task_error.visible_fraction);
  status.add("corner error [px]", last_input_.task_error.corner_error);
  status.add("age of d2 [s]", last_input_.depth.age);
  status.add("d2 [m]", last_input_.depth.d2);
  status.add("insertion point beside the shaft [m]", last_input_.depth.lateral_offset);
  status.add("age of the manual command [s]", last_input_.manual.age);
  const servo::InsertionPointEstimate& point = controller_.insertionPoint().estimate();
  status.add("insertion point by the poses, from its frame [m]", point.valid ? point.point.norm() : 0.0);
  status.add("its standard deviation [m]", point.valid ? std::sqrt(point.covariance.trace() / 3.0) : 0.0);
  status.add("residual of the shafts [m]", controller_.insertionPoint().residual());
  status.add("delay [s]", controller_.servo().delay());
  status.add("breathing rate [Hz]", controller_.servo().breathingRate());
  status.add("factor of the gains", controller_.servo().gainFactor());
  status.add("pan [rad/s]", last_output_.command.pan);
  status.add("tilt [rad/s]", last_output_.command.tilt);
  status.add("spin [rad/s]", last_output_.command.spin);
  status.add("insertion [m/s]", last_output_.command.insertion);
}

}  // namespace laparoscope_servo::skin
