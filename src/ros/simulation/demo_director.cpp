#include "ros/simulation/demo_director.h"

#include <laparoscope_servo/SelectRoi.h>
#include <ros/callback_queue.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/robust/largest.h"
#include "ros/common/clocks.h"

namespace laparoscope_servo {

namespace {
constexpr double kPatience = 10.0;  // s
}

void describeDirector(parameters::Table& table, DemoConfig& c) {
  table.text("control", c.control, "path of the emulator's control socket").required("/tmp/aesop_control");
  table.text("summary", c.summary, "JSON file to write; empty: none");
  table.number("roi_side", c.roi_side, {16, 2000}, "px", "of the square region, in the middle of the image");
  table.number("pan", c.pan, {-0.5, 0.5}, "rad", "by hand, from the start pose");
  table.number("tilt", c.tilt, {-0.5, 0.5}, "rad", "by hand, from the start pose");
  table.number("spin", c.spin, {-1.5, 1.5}, "rad", "by hand, from the start pose");
  table.number("deeper", c.deeper, {-0.05, 0.05}, "m", "by hand, from the start pose");
  table.number("hand_time", c.hand_time, {0.5, 60}, "s", "that the hand takes");
  table.number("settled_error", c.settled_error, {0.1, 100}, "px", "within which the region's centre is back");
  table.number("settled_scale", c.settled_scale, {0.001, 1}, "ratio", "within which its size is back");
  table.number("settled_time", c.settled_time, {0.1, 60}, "s", "for which both stay");
  table.flag("cross_instrument", c.cross_instrument, "the instrument crosses once the loop has settled");
  table.number("startup_timeout", c.startup_timeout, {1, 600}, "s", "for the nodes to be there");
  table.number("timeout", c.timeout, {1, 600}, "s", "for each step");
}

void describe(parameters::Table& table, DemoConfig& c) {
  describeDirector(table, c);
  describe(table, c.emulator);
}

std::vector<std::string> validate(const DemoConfig& config) {
  std::vector<std::string> errors = parameters::errorsOf(config);
  for (const std::string& error : sim::validate(config.emulator)) {
    if (std::find(errors.begin(), errors.end(), error) == errors.end()) errors.push_back(error);
  }
  return errors;
}

DemoDirector::DemoDirector(ros::NodeHandle node, const DemoConfig& config)
    : config_(config),
      steps_(demoSteps(config.hand_time, config.settled_time, config.cross_instrument)),
      node_(node),
      kinematics_(config.emulator.kinematics),
      settling_(config.settled_error, config.settled_scale, config.settled_time) {
  camera_info_subscriber_ = node_.subscribe<sensor_msgs::CameraInfo>(
      "camera/camera_info", 1, [this](const sensor_msgs::CameraInfoConstPtr& info) { camera_info_ = *info; });
  homography_subscriber_ = node_.subscribe("tracker/homography", 100, &DemoDirector::onHomography, this);
  state_subscriber_ = node_.subscribe<OperatingState>(
      "aesop/operating_state", 10, [this](const OperatingStateConstPtr& state) { operating_state_ = state->state; });
}

DemoSummary DemoDirector::run() {
  try {
    play();
  } catch (const std::runtime_error& error) {  // Failed, or the emulator has gone
    summary_.reason = error.what();
  }
  summary_.converged = summary_.reason.empty();
  return summary_;
}

void DemoDirector::announce(DemoStepIndex step) {
  ROS_INFO("%s", announcement(steps_, step).c_str());
}

void DemoDirector::play() {
  waitForNodes();
  selectRoi();
  moveByHand();
  closeLoop();
  if (config_.cross_instrument) crossInstrument();
  finish();
}

void DemoDirector::waitFor(const std::string& what, double timeout, const std::function<bool()>& condition) {
  const double end = steadyNow() + timeout;
  while (!condition()) {
    if (!ros::ok()) throw Failed("interrupted while waiting for " + what);
    if (steadyNow() > end) {
      throw Failed(what + " did not come about within " + std::to_string(static_cast<int>(std::lround(timeout))) +
                   " s");
    }
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.02));
  }
}

// A busy machine makes the nodes refuse for a moment: an image or a status is late.
template <typename Service>
void DemoDirector::call(const std::string& name, Service service, double patience) {
  const double last_try = steadyNow() + patience;
  bool answered = false;
  waitFor("an answer of " + name, patience + 5.0, [&] {
    answered = ros::service::call(name, service);
    return (answered && service.response.success) || steadyNow() > last_try;
  });
  if (!answered) throw Failed("the service " + name + " cannot be called");
  if (!service.response.success) throw Failed("the service " + name + " refused: " + service.response.message);
  ROS_INFO("%s: %s", name.c_str(), service.response.message.c_str());
}

void DemoDirector::onHomography(const Homography& message) {
  homography_ = message;
  if (!selected_) return;
  const bool tracking = message.state == Homography::TRACKING;
  ++summary_.total_frames;
  summary_.tracked_frames += tracking ? 1 : 0;
  if (tracking) error_ = viewError(message, roi_);
  settling_.update(steadyNow(), tracking, error_);
  if (crossing_) {
    ++summary_.crossing_frames;
    summary_.crossing_tracked_frames += tracking ? 1 : 0;
    if (tracking) summary_.crossing_error_px = robust::largest(summary_.crossing_error_px, error_.centre);
    summary_.crossing_visible_fraction = std::min(summary_.crossing_visible_fraction, message.visible_fraction);
  }
}

Eigen::Isometry3d DemoDirector::truePose() {
  return kinematics_.optical(emulator_->state().q);
}

PoseError DemoDirector::truth() {
  return poseError(start_pose_, truePose(), config_.emulator.arm.insertion_point);
}

void DemoDirector::waitForNodes() {
  announce(kDemoNodes);
  waitFor("the emulated arm at " + config_.control, config_.startup_timeout, [this] {
    try {
      emulator_ = std::make_unique<sim::EmulatorControlClient>(config_.control);
    } catch (const std::runtime_error&) {
      return false;  // not yet there
    }
    return true;
  });
  waitFor("camera/camera_info", config_.startup_timeout, [this] { return camera_info_.has_value(); });
  waitFor("tracker/homography", config_.startup_timeout, [this] { return homography_.has_value(); });
  waitFor("aesop/operating_state DISABLED", config_.startup_timeout, [this] { return operating_state_ == "DISABLED"; });
  for (const char* name : {"tracker/select_roi", "aesop/enable", "controller/engage"}) {
    waitFor(std::string("service ") + name, config_.startup_timeout,
            [name] { return ros::service::exists(name, false); });
  }
}

void DemoDirector::selectRoi() {
  announce(kDemoSelect);
  roi_.width = roi_.height = std::floor(config_.roi_side);
  roi_.x = std::max(0.0, std::floor((camera_info_->width - roi_.width) / 2.0));
  roi_.y = std::max(0.0, std::floor((camera_info_->height - roi_.height) / 2.0));
  SelectRoi select;
  select.request.roi.x_offset = static_cast<std::uint32_t>(roi_.x);
  select.request.roi.y_offset = static_cast<std::uint32_t>(roi_.y);
  select.request.roi.width = static_cast<std::uint32_t>(roi_.width);
  select.request.roi.height = static_cast<std::uint32_t>(roi_.height);
  start_pose_ = truePose();
  call(node_.resolveName("tracker/select_roi"), select);
  homography_.reset();
  waitFor("tracking of the ROI", 5.0, [this] { return homography_ && homography_->state == Homography::TRACKING; });
  selected_ = true;
}

void DemoDirector::moveByHand() {
  announce(kDemoHand);
  // Tilt is a turn about x, which takes the optical axis up.
  emulator_->hand({config_.pan, config_.tilt, config_.spin, config_.deeper}, config_.hand_time);
  const double end = steadyNow() + config_.hand_time + 0.5;
  waitFor("the end of the motion by hand", config_.hand_time + 5.0, [end] { return steadyNow() > end; });
  if (homography_->state != Homography::TRACKING) throw Failed("the ROI was lost while the scope was moved by hand");
  summary_.start_error_px = error_.centre;
  summary_.start_scale_error = error_.scale;
  summary_.start_truth = truth();
}

void DemoDirector::closeLoop() {
  announce(kDemoLoop);
  call(node_.resolveName("aesop/enable"), std_srvs::Trigger(), kPatience);
  waitFor("aesop/operating_state ENABLED", 5.0, [this] { return operating_state_ == "ENABLED"; });
  std_srvs::SetBool engage;
  engage.request.data = static_cast<std::uint8_t>(true);
  // The controller may hear of ENABLED a moment later.
  call(node_.resolveName("controller/engage"), engage, kPatience);
  const double begin = steadyNow();
  waitFor("convergence", config_.timeout, [this] { return settling_.settled(); });
  summary_.settling_time = std::max(0.0, settling_.since() - begin);
  ROS_INFO("settled after %.1f s", summary_.settling_time);
}

void DemoDirector::crossInstrument() {
  announce(kDemoInstrument);
  call(node_.resolveName("simulated_camera/cross_instrument"), std_srvs::Trigger());
  summary_.crossed = true;
  crossing_ = true;
  // It is over when the region was partly covered and is not any more.
  waitFor("the instrument in front of the ROI", config_.timeout,
          [this] { return summary_.crossing_visible_fraction < 0.9; });
  ROS_INFO("the instrument is in front of the region");
  waitFor("the end of the crossing", config_.timeout,
          [this] { return homography_->state == Homography::TRACKING && homography_->visible_fraction > 0.95; });
  crossing_ = false;
  const double end = steadyNow() + config_.settled_time;
  waitFor("convergence after the crossing", config_.timeout,
          [this, end] { return steadyNow() > end && settling_.settled(); });
}

void DemoDirector::finish() {
  summary_.final_error_px = error_.centre;
  summary_.final_scale_error = error_.scale;
  summary_.final_truth = truth();
}

}  // namespace laparoscope_servo
