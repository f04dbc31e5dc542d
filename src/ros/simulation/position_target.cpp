#include "ros/simulation/position_target.h"

#include <tf2/exceptions.h>

#include <Eigen/LU>
#include <cstddef>

#include "ros/common/eigen_messages.h"
#include "ros/simulation/scene_markers.h"

namespace laparoscope_servo {

namespace {

using visualization_msgs::Marker;

constexpr double kLine = 0.0008;  // m

Marker lines(const std::string& base, int id, int type) {
  Marker result = marker(base, "position_target", id, type);
  result.scale.x = kLine;
  return result;
}

}  // namespace

void PositionTarget::take(const Homography& message, const tf2::BufferCore& tf) {
  const ros::Time selected = message.state == Homography::IDLE ? ros::Time() : message.reference_stamp;
  if (selected != selection_) base_T_then_.reset();
  selection_ = selected;
  if (base_T_then_ || selection_.isZero()) return;
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> g(message.g.data());
  geometry::Quadrilateral corners;
  for (std::size_t k = 0; k < 4; ++k) corners[k] = {message.corners[2 * k], message.corners[2 * k + 1]};
  outline_ = geometry::apply(g.inverse(), corners);
  try {
    base_T_then_ = fromMessage(tf.lookupTransform(base_, camera_, selection_).transform);
  } catch (const tf2::TransformException&) {
    // With the next image.
  }
}

void PositionTarget::addTo(visualization_msgs::MarkerArray& array, bool wanted, const geometry::PinholeCamera& camera,
                           const cv::Size& size, double depth, const std::optional<Eigen::Vector3d>& camera_now) const {
  Marker view = lines(base_, 0, Marker::LINE_LIST), outline = lines(base_, 1, Marker::LINE_STRIP),
         way = lines(base_, 2, Marker::LINE_LIST);
  if (wanted && base_T_then_) {
    view.points = viewMarker(base_, camera, size, depth).points;
    for (std::size_t k = 0; k <= 4; ++k) {
      const Eigen::Vector3d ray = camera.inverseMatrix() * outline_[k % 4].homogeneous();
      outline.points.push_back(pointMessage(depth * ray));
    }
    for (Marker* m : {&view, &outline}) {
      m->pose.position = pointMessage(base_T_then_->translation());
      m->pose.orientation = rotationMessage(base_T_then_->linear());
    }
    if (camera_now) way.points = {pointMessage(*camera_now), pointMessage(base_T_then_->translation())};
  }
  for (Marker* m : {&view, &outline, &way}) {
    setColour(*m, 0.3, 0.55, 1.0, 0.9);  // as the display in space has where the region shall be
    if (m->points.empty()) m->action = Marker::DELETE;
    array.markers.push_back(*m);
  }
}

}  // namespace laparoscope_servo
