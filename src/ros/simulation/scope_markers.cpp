#include "ros/simulation/scope_markers.h"

#include "ros/common/parameter_names.h"
#include "ros/simulation/scene_markers.h"

namespace laparoscope_servo {

namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double kPeriod = 0.1;         // s
constexpr double kLinkRadius = 0.014;   // m
constexpr double kPointRadius = 0.002;  // m: the display in space draws how well it is known about it
const char* const kBase = "aesop_base";
const char* const kEndEffector = "end_effector";
const std::vector<std::string> kLinks{kBase, "link_1", "link_2", "link_3", "link_4", "link_5", "link_6", kEndEffector};

}  // namespace

void describe(parameters::Table& table, ScopeMarkersConfig& c) {
  describeFramePrefix(table, c.frame_prefix);
  describeFrame(table, "camera_frame", c.camera_frame, "of the camera, without the prefix");
  describeFrame(table, "insertion_point", c.insertion_point, "of the insertion point, without the prefix");
  table.number("view_depth", c.view_depth, {1e-3, 10}, "m", "how far the field of view is drawn");
  table.number("scope_radius", c.scope_radius, {1e-4, 1}, "m", "of the shaft");
}

std::vector<std::string> validate(const ScopeMarkersConfig& config) {
  return parameters::errorsOf(config);
}

ScopeMarkers::ScopeMarkers(ros::NodeHandle node, ros::NodeHandle private_node, const ScopeMarkersConfig& config)
    : config_(config),
      tf_listener_(tf_),
      target_(config.frame_prefix + kBase, config.frame_prefix + config.camera_frame),
      publisher_(private_node.advertise<MarkerArray>("markers", 1)),
      camera_info_subscriber_(node.subscribe<sensor_msgs::CameraInfo>(
          "camera_info", 1, [this](const sensor_msgs::CameraInfoConstPtr& info) { takeCameraInfo(*info); })),
      homography_subscriber_(node.subscribe<Homography>(
          "homography", 1, [this](const HomographyConstPtr& message) { target_.take(*message, tf_); })),
      state_subscriber_(node.subscribe<ControllerState>(
          "controller/state", 1,
          [this](const ControllerStateConstPtr& state) { has_target_ = state->task == ControllerState::POSITION; })),
      timer_(node.createWallTimer(ros::WallDuration(kPeriod), [this](const ros::WallTimerEvent&) { publish(); })) {}

std::optional<Eigen::Vector3d> ScopeMarkers::origin(const std::string& frame) const {
  try {
    const auto transform =
        tf_.lookupTransform(config_.frame_prefix + kBase, config_.frame_prefix + frame, ros::Time(0));
    const auto& t = transform.transform.translation;
    return Eigen::Vector3d(t.x, t.y, t.z);
  } catch (const tf2::TransformException&) {
    return std::nullopt;  // not yet: rviz's own display of tf says what is missing
  }
}

void ScopeMarkers::takeCameraInfo(const sensor_msgs::CameraInfo& info) {
  camera_ = geometry::cameraFromRowMajor(info.K.data());
  if (!camera_->error().empty()) camera_.reset();
  image_size_ = {static_cast<int>(info.width), static_cast<int>(info.height)};
}

void ScopeMarkers::publish() {
  if (publisher_.getNumSubscribers() == 0) return;
  MarkerArray array;
  addArm(array);
  addScope(array);
  addInsertionPoint(array);
  addTarget(array);
  publisher_.publish(array);
}

void ScopeMarkers::addArm(MarkerArray& array) const {
  for (std::size_t k = 0; k + 1 < kLinks.size(); ++k) {
    const auto a = origin(kLinks[k]), b = origin(kLinks[k + 1]);
    if (!a || !b) continue;
    const double radius = kLinks[k + 1] == kEndEffector ? config_.scope_radius * 1.6 : kLinkRadius;
    array.markers.push_back(cylinderMarker(config_.frame_prefix + kBase, "arm", static_cast<int>(k), *a, *b, radius));
    setColour(array.markers.back(), 0.85, 0.86, 0.88, 1.0);
  }
}

void ScopeMarkers::addScope(MarkerArray& array) const {
  const auto a = origin(kEndEffector), b = origin(config_.camera_frame);
  if (!a || !b) return;
  array.markers.push_back(cylinderMarker(config_.frame_prefix + kBase, "scope", 0, *a, *b, config_.scope_radius));
  setColour(array.markers.back(), 0.25, 0.27, 0.32, 1.0);
  if (!camera_) return;
  array.markers.push_back(
      viewMarker(config_.frame_prefix + config_.camera_frame, *camera_, image_size_, config_.view_depth));
  array.markers.back().frame_locked = static_cast<std::uint8_t>(true);
}

void ScopeMarkers::addTarget(MarkerArray& array) const {
  if (camera_)
    target_.addTo(array, has_target_, *camera_, image_size_, config_.view_depth, origin(config_.camera_frame));
}

void ScopeMarkers::addInsertionPoint(MarkerArray& array) const {
  if (!origin(config_.insertion_point)) return;
  Marker sphere = marker(config_.frame_prefix + config_.insertion_point, "insertion_point", 0, Marker::SPHERE);
  sphere.scale.x = sphere.scale.y = sphere.scale.z = 2.0 * kPointRadius;
  setColour(sphere, 1.0, 0.75, 0.1, 0.9);
  array.markers.push_back(sphere);
}

}  // namespace laparoscope_servo
