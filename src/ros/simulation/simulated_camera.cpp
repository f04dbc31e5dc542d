#include "ros/simulation/simulated_camera.h"

#include <sensor_msgs/distortion_models.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <exception>

#include "laparoscope_servo/sim/arm.h"
#include "laparoscope_servo/sim/texture.h"
#include "ros/common/parameter_names.h"
#include "ros/simulation/scene_markers.h"
#include "ros/tracker/result_messages.h"

namespace laparoscope_servo {

namespace {

constexpr double kThrottle = 5.0;  // s between two lines of the log about the same kind of error

sensor_msgs::CameraInfo cameraInfo(const sim::ScopeCameraConfig& camera, const std::string& frame) {
  sensor_msgs::CameraInfo info;
  info.header.frame_id = frame;
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  info.D.assign(5, 0.0);
  const geometry::PinholeCamera& k = camera.intrinsics;
  info.K = {k.fx, 0.0, k.cx, 0.0, k.fy, k.cy, 0.0, 0.0, 1.0};
  info.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.P = {k.fx, 0.0, k.cx, 0.0, 0.0, k.fy, k.cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

// aesop_base_T_laparoscope_optical at the arm's start pose.
Eigen::Isometry3d startPose(const aesop::Kinematics& kinematics, const sim::ArmConfig& arm) {
  return kinematics.optical(sim::Arm(kinematics, arm).position());
}

}  // namespace

void describeCamera(parameters::Table& table, SimulatedCameraConfig& c) {
  table.text("control", c.control, "path of the emulator's control socket").required("/tmp/aesop_control");
  describeFramePrefix(table, c.frame_prefix);
  describeFrame(table, "frame_id", c.frame_id, "of the images");
  describeFrame(table, "base_frame", c.base_frame, "of the markers");
  describe(table, c.scene);
}

void describe(parameters::Table& table, SimulatedCameraConfig& c) {
  describeCamera(table, c);
  describe(table, c.emulator);
}

std::vector<std::string> validate(const SimulatedCameraConfig& config) {
  std::vector<std::string> errors = parameters::errorsOf(config);
  for (const std::string& error : sim::validate(config.emulator)) {
    if (std::find(errors.begin(), errors.end(), error) == errors.end()) errors.push_back(error);
  }
  return errors;
}

SimulatedCamera::SimulatedCamera(ros::NodeHandle node, ros::NodeHandle private_node,
                                 const SimulatedCameraConfig& config)
    : config_(config),
      kinematics_(config.emulator.kinematics),
      camera_(config.scene, sim::placeTissue(config.scene.tissue, startPose(kinematics_, config.emulator.arm))),
      camera_info_(cameraInfo(config.scene.camera, config.frame_id)),
      transport_(node),
      publisher_(transport_.advertiseCamera("image_raw", 2)),
      tissue_publisher_(private_node.advertise<visualization_msgs::Marker>("tissue", 1, true)),
      instrument_publisher_(private_node.advertise<visualization_msgs::MarkerArray>("instrument", 2)) {
  tissue_publisher_.publish(
      tissueMarker(config.base_frame, camera_.tissue().pose(), camera_.tissue().texture(), config.scene.tissue.width));
  cross_service_ = private_node.advertiseService("cross_instrument", &SimulatedCamera::crossInstrument, this);
}

void SimulatedCamera::run() {
  ros::WallRate rate(config_.scene.camera.rate);
  while (ros::ok()) {
    if (const std::optional<Pose> now = pose()) publishImage(*now);
    ros::spinOnce();
    rate.sleep();
  }
}

std::optional<SimulatedCamera::Pose> SimulatedCamera::pose() {
  try {
    if (!emulator_) {
      emulator_ = std::make_unique<sim::EmulatorControlClient>(config_.control);
      ROS_INFO("connected to the emulated arm at %s", config_.control.c_str());
    }
    const ros::Time before = ros::Time::now();
    const aesop::JointVector q = emulator_->state().q;
    return Pose{kinematics_.optical(q), before + (ros::Time::now() - before) * 0.5};
  } catch (const std::exception& error) {
    ROS_WARN_THROTTLE(kThrottle, "no images: the emulated arm does not answer at %s: %s", config_.control.c_str(),
                      error.what());
    emulator_.reset();
    return std::nullopt;
  }
}

void SimulatedCamera::publishImage(const Pose& pose) {
  const std::optional<Eigen::Vector3d> tip = instrumentTip(pose.stamp.toSec());
  const sim::RenderedImage rendered = camera_.render(pose.base_T_camera, pose.stamp.toSec(), tip);
  camera_info_.header.stamp = pose.stamp;
  publisher_.publish(*imageMessage(camera_info_.header, rendered.image), camera_info_);
  publishInstrument(tip);
}

std::optional<Eigen::Vector3d> SimulatedCamera::instrumentTip(double now) {
  const sim::InstrumentConfig& instrument = config_.scene.instrument;
  if (instrument.period > 0.0 && (!crossing_ || now >= *crossing_ + instrument.period)) crossing_ = now;
  return crossing_ ? sim::instrumentTip(instrument, now - *crossing_) : std::nullopt;
}

void SimulatedCamera::publishInstrument(const std::optional<Eigen::Vector3d>& tip) {
  if (!tip && !instrument_shown_) return;
  instrument_shown_ = tip.has_value();
  visualization_msgs::MarkerArray array;
  int id = 0;
  for (const sim::Capsule& capsule :
       sim::instrumentAt(config_.scene.instrument, tip.value_or(Eigen::Vector3d::Zero()))) {
    const Eigen::Isometry3d& base_T_tissue = camera_.tissue().pose();
    array.markers.push_back(cylinderMarker(config_.base_frame, "instrument", id++, base_T_tissue * capsule.a,
                                           base_T_tissue * capsule.b, capsule.radius));
    setColour(array.markers.back(), 0.75, 0.75, 0.8, 1.0);
    if (!tip) array.markers.back().action = visualization_msgs::Marker::DELETE;
  }
  instrument_publisher_.publish(array);
}

bool SimulatedCamera::crossInstrument(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  crossing_ = ros::Time::now().toSec();
  response.success = static_cast<std::uint8_t>(true);
  response.message =
      "the instrument crosses the picture within " + std::to_string(config_.scene.instrument.crossing_time) + " s";
  return true;
}

}  // namespace laparoscope_servo
