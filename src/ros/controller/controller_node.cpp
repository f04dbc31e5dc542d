#include "ros/controller/controller_node.h"

#include <laparoscope_servo/ControllerState.h>
#include <laparoscope_servo/ScopeVelocity.h>
#include <ros/callback_queue.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "ros/common/clocks.h"
#include "ros/controller/controller_conversions.h"
#include "ros/controller/plane_markers.h"

namespace laparoscope_servo {

namespace {

constexpr double kCautionPause = 1.0;  // s, between two cautions on the terminal

const char* doing(servo::Task task) {
  switch (task) {
    case servo::Task::kHoldView:
      return "follows the region of interest";
    case servo::Task::kManual:
      return "is driven by hand";
    case servo::Task::kStabilise:
      return "keeps the view";
    case servo::Task::kCentreTip:
      return "keeps the tip in its zone";
    case servo::Task::kFollow:
      return "follows the object";
    case servo::Task::kPoints:
      return "brings the points to their places";
    case servo::Task::kPosition:
      return "brings the region back by its homography";
    case servo::Task::kParallel:
      return "faces the tissue";
  }
  return "";
}

}  // namespace

ControllerNode::ControllerNode(ros::NodeHandle node, ros::NodeHandle private_node, const ControllerNodeConfig& config)
    : config_(config),
      controller_(config.control),
      stops_(config.external_stops),
      scope_pose_(config),
      last_now_(ros::Time::now()),
      inputs_(node, private_node, config,
              {[this] { checkTime(); }, [this](const std::string& sender) { onStop(sender); },
               [this](const std::string& frame) { return scope_pose_.shaftFrom(frame); },
               [this]() -> const servo::DepthInput& { return last_input_.depth; }, [this] { onTick(); }}),
      diagnostics_(node, private_node),
      command_publisher_(node.advertise<ScopeVelocity>("servo_command", 1)),
      state_publisher_(private_node.advertise<ControllerState>("state", 1, true)),
      plane_publisher_(private_node.advertise<visualization_msgs::MarkerArray>("tissue_plane", 1, true)),
      live_(private_node, config) {
  diagnostics_.setHardwareID("none");
  diagnostics_.add("control", this, &ControllerNode::report);
  publish(controller_.update(input()));
  select_task_service_ = private_node.advertiseService("select_task", &ControllerNode::onSelectTask, this);
  engage_service_ = private_node.advertiseService("engage", &ControllerNode::onEngage, this);
  tick_timer_ =
      node.createSteadyTimer(ros::WallDuration(1.0 / config_.rate), [this](const ros::SteadyTimerEvent&) { onTick(); });
  // Not Updater::update(), which waits for ROS time, and that may have jumped back.
  diagnostics_timer_ = node.createSteadyTimer(ros::WallDuration(diagnostics_.getPeriod()),
                                              [this](const ros::SteadyTimerEvent&) { diagnostics_.force_update(); });
}

int ControllerNode::run(const std::function<bool()>& stop) {
  try {
    while (ros::ok() && !stop() && !stops_.mustEnd()) {
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
      service_errors_.rethrow();
    }
    controller_.disengage("the controller ends");
    publish(controller_.update(input()));
  } catch (const std::exception& error) {
    fail(error.what());
    return 1;
  }
  return stops_.mustEnd() ? 1 : 0;
}

// Does not use the controller, which may have failed.
void ControllerNode::fail(const std::string& what) {
  servo::ControllerOutput output;
  output.state = servo::ControllerState::kFault;
  output.reason = "the controller has failed and ends: " + what;
  publish(output);
}

// Has no effect in FAULT, which stays until an operator disengages.
void ControllerNode::onStop(const std::string& sender) {
  if (!controller_.engaged()) return;
  controller_.stop("stopped by " + sender, steadyNow());
  onTick();
}

void ControllerNode::watchOutside() {
  const double now = steadyNow();
  std::string stop = stops_.takeStop(now);
  if (stop.empty()) stop = stops_.obstacle(now);
  // After a pause of this process the master looks silent; the pause is then the reason.
  if (!stop.empty()) controller_.stop(stop, now);
}

void ControllerNode::onTick() {
  checkTime();
  watchOutside();
  if (live_.take(changed_)) controller_.retune(changed_.control);
  last_input_ = input();
  clock_jump_.clear();
  inputs_.taken();
  publish(controller_.update(last_input_));
  inputs_.know(controller_.engaged(), controller_.task());
  publishPlane();
}

// A looped bag or a restarted simulation: earlier data is invalid, and the arm must not go on.
void ControllerNode::checkTime() {
  const ros::Time now = ros::Time::now();
  const bool back = (last_now_ - now).toSec() > config_.control.safety.max_clock_difference;
  last_now_ = now;
  if (!back) return;
  inputs_.forgetStamps();
  scope_pose_.clear();
  clock_jump_ = "ROS time jumped back";
}

servo::ControllerInput ControllerNode::input() {
  const double steady_now = steadyNow();
  servo::ControllerInput input;
  input.time = steady_now;
  input.depth = scope_pose_.depth(controller_.engaged(), steady_now);
  if (!scope_pose_.fault().empty()) clock_jump_ = scope_pose_.fault();
  input.clock_jump = clock_jump_;
  inputs_.fill(input, steady_now);
  return input;
}

void ControllerNode::publish(const servo::ControllerOutput& output) {
  ScopeVelocity command = toMessage(output.command);
  command.header.stamp = ros::Time::now();
  command.header.frame_id = config_.shaft;
  command_publisher_.publish(command);
  const bool changed =
      output.state != last_output_.state || output.reason != last_output_.reason || output.task != last_output_.task;
  const bool same_caution = output.caution == last_output_.caution;
  const servo::ControllerState before = last_output_.state;
  last_output_ = output;
  if (changed) said_caution_.clear();
  if (!changed) warn(output.caution);
  if (!changed && same_caution && state_published_) return;
  publishState(output);
  if (!changed) return;
  if (output.state == servo::ControllerState::kServo) {
    ROS_INFO("The scope %s.", doing(output.task));
  } else if (output.state == servo::ControllerState::kFault) {
    ROS_ERROR("The scope stands still: %s.", output.reason.c_str());
  } else if (before != servo::ControllerState::kIdle || output.engaged()) {
    ROS_WARN("The scope stands still: %s.", output.reason.c_str());
  }
}

void ControllerNode::warn(const std::string& caution) {
  if (caution.empty() || caution == said_caution_ || steadyNow() < next_caution_) return;
  said_caution_ = caution;
  next_caution_ = steadyNow() + kCautionPause;
  ROS_WARN("The scope: %s.", caution.c_str());
}

void ControllerNode::publishState(const servo::ControllerOutput& output) {
  ControllerState state = toMessage(output);
  state.header.stamp = ros::Time::now();
  state_publisher_.publish(state);
  state_published_ = true;
}

void ControllerNode::publishPlane() {
  const servo::ParallelFigures figures = controller_.figures().parallel;
  const Eigen::Vector3d normal = figures.is_known ? figures.normal : Eigen::Vector3d(Eigen::Vector3d::Zero());
  if (normal == plane_published_) return;
  plane_published_ = normal;
  plane_publisher_.publish(planeMarkers(config_.insertion_point, figures));
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
  inputs_.describe(status);
  status.add("task", state.task);
  status.add("state", state.state);
  status.add("reason", state.reason);
  status.add("speed scale", last_output_.speed_scale);
  const std::string problem = controller_.problem(last_input_);
  stops_.describe(steadyNow(), status);
  status.add("ready to move", problem.empty() ? "yes" : "no: " + problem);
  const servo::TaskErrorInput& seen = last_input_.seenBy(last_output_.task);
  status.add("age of the task error [s]", seen.age);
  status.add("age of its image [s]", seen.image_age);
  status.add("visible fraction", seen.visible_fraction);
  status.add("corner error [px]", seen.corner_error);
  status.add("age of d2 [s]", last_input_.depth.age);
  status.add("d2 [m]", last_input_.depth.d2);
  scope_pose_.describe(status);
  status.add("insertion point beside the shaft [m]", last_input_.depth.lateral_offset);
  status.add("age of the manual command [s]", last_input_.manual.age);
  const servo::ControllerFigures figures = controller_.figures();
  const servo::InsertionPointEstimate& point = figures.insertion_point;
  status.add("insertion point by the poses, from its frame [m]", point.valid ? point.point.norm() : 0.0);
  status.add("its standard deviation [m]", point.valid ? std::sqrt(point.covariance.trace() / 3.0) : 0.0);
  status.add("residual of the shafts [m]", figures.insertion_point_residual);
  status.add("views of the tissue's plane", figures.parallel.views);
  status.add("standard deviation of its normal [rad]", figures.parallel.stddev);
  status.add("delay [s]", figures.delay);
  status.add("breathing rate [Hz]", figures.breathing_rate);
  status.add("evidence of a fault in the picture", figures.evidence);
  status.add("factor of the gains", figures.gain_factor);
  status.add("pan [rad/s]", last_output_.command.pan);
  status.add("tilt [rad/s]", last_output_.command.tilt);
  status.add("spin [rad/s]", last_output_.command.spin);
  status.add("insertion [m/s]", last_output_.command.insertion);
}

}  // namespace laparoscope_servo
