#include "screen/space/space_link.h"

#include <vector>

#include "ros/common/clocks.h"

namespace laparoscope_servo::screen {

namespace {

std::optional<ControllerBounds> boundsOf(const ros::NodeHandle& node) {
  ControllerBounds bounds;
  std::vector<double> axis;
  const std::string controller = "controller/";
  if (!node.getParam(controller + "range/min_depth", bounds.range.min_depth) ||
      !node.getParam(controller + "range/max_depth", bounds.range.max_depth) ||
      !node.getParam(controller + "range/cone", bounds.range.cone) || !node.getParam(controller + "range/axis", axis) ||
      axis.size() != 3 || !node.getParam(controller + "features/desired_depth", bounds.desired_depth) ||
      !node.getParam(controller + "insertion_point/prior_stddev", bounds.prior_stddev))
    return std::nullopt;
  bounds.range.axis = Eigen::Map<const Eigen::Vector3d>(axis.data());
  return bounds;
}

}  // namespace

SpaceLink::SpaceLink(const ros::NodeHandle& node, const std::string& camera_info)
    : node_(node),
      features_(std::make_shared<FeatureLink>(node, [this](const std::string& tracker, const TrackedFeatures& message) {
        keeper_.take(tracker, message, steadyNow());
      })) {
  const auto hints = ros::TransportHints().tcpNoDelay();  // as the panel's, with which it shares the connections
  const auto locked = [this](auto& kept, const auto& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    kept = message;
  };
  preview_subscriber_ = node_.subscribe<sensor_msgs::Image>(
      "tracker/preview", 1,
      [this](const sensor_msgs::ImageConstPtr& preview) {
        const std::lock_guard<std::mutex> lock(mutex_);
        preview_ = preview;
        preview_at_ = steadyNow();
      },
      ros::VoidConstPtr(), hints);
  homography_subscriber_ = node_.subscribe<Homography>(
      "tracker/homography", 100, [this](const HomographyConstPtr& result) { keeper_.take(*result, 0.0, steadyNow()); },
      ros::VoidConstPtr(), hints);
  areas_subscriber_ = node_.subscribe<AreaSelection>(
      "tracker/areas", 100, [this](const AreaSelectionConstPtr& areas) { keeper_.take(*areas); }, ros::VoidConstPtr(),
      hints);
  state_subscriber_ = node_.subscribe<TrackerState>(
      "tracker/state", 10, [this](const TrackerStateConstPtr& state) { keeper_.take(*state, steadyNow()); },
      ros::VoidConstPtr(), hints);
  camera_info_subscriber_ = node_.subscribe<sensor_msgs::CameraInfo>(
      camera_info, 1, [this, locked](const sensor_msgs::CameraInfoConstPtr& info) { locked(camera_info_, info); });
  calibration_subscriber_ = node_.subscribe<CalibrationState>(
      "aesop/calibrate_insertion_point/state", 1,
      [this, locked](const CalibrationStateConstPtr& state) { locked(calibration_, state); });
}

Facts SpaceLink::facts(double now) {
  sensor_msgs::ImageConstPtr preview;
  double at = kNever;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    preview.swap(preview_);
    at = preview_at_;
  }
  const bool recorded = ros::Time::isSimTime();
  if (preview) {
    const double age = recorded ? 0.0 : (ros::Time::now() - preview->header.stamp).toSec() - (now - at);
    keeper_.take(*preview, age, at);
  }
  return keeper_.facts();
}

sensor_msgs::CameraInfoConstPtr SpaceLink::cameraInfo() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return camera_info_;
}

CalibrationStateConstPtr SpaceLink::calibration() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return calibration_;
}

std::optional<ControllerBounds> SpaceLink::bounds() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return bounds_;
}

void SpaceLink::findFeatures() {
  feature_calls_.ask([features = features_]() -> std::function<void()> {
    features->find();
    return nullptr;
  });
}

void SpaceLink::askForBounds() {
  calls_.ask([this, node = node_]() -> std::function<void()> {
    return [this, bounds = boundsOf(node)] {
      const std::lock_guard<std::mutex> lock(mutex_);
      bounds_ = bounds;
    };
  });
}

}  // namespace laparoscope_servo::screen
