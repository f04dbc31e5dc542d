#include "ros/controller/plane_markers.h"

#include <Eigen/Geometry>

#include "ros/common/eigen_messages.h"

namespace laparoscope_servo {

namespace {

using visualization_msgs::Marker;

constexpr double kSide = 0.08;   // m, of the square that stands for the plane
constexpr double kArrow = 0.04;  // m, of the normal

Marker marker(const std::string& frame, int id, int type) {
  Marker result;
  result.header.frame_id = frame;
  result.ns = "tissue_plane";
  result.id = id;
  result.type = type;
  result.action = Marker::ADD;
  result.pose.orientation.w = 1.0;
  result.color.r = 0.2F;
  result.color.g = 0.9F;
  result.color.b = 1.0F;
  result.color.a = 0.5F;
  return result;
}

}  // namespace

visualization_msgs::MarkerArray planeMarkers(const std::string& insertion_point,
                                             const servo::ParallelFigures& figures) {
  visualization_msgs::MarkerArray array;
  const Eigen::Vector3d foot = figures.distance * figures.normal;

  Marker plane = marker(insertion_point, 0, Marker::CUBE);
  plane.pose.position = pointMessage(foot);
  plane.pose.orientation =
      rotationMessage(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), figures.normal).toRotationMatrix());
  plane.scale.x = plane.scale.y = kSide;
  plane.scale.z = 0.0005;
  array.markers.push_back(plane);

  Marker normal = marker(insertion_point, 1, Marker::ARROW);
  normal.points = {pointMessage(foot), pointMessage(foot - kArrow * figures.normal)};
  normal.scale.x = 0.002;
  normal.scale.y = 0.005;
  array.markers.push_back(normal);

  Marker target = marker(insertion_point, 2, Marker::LINE_LIST);
  target.points = {pointMessage(Eigen::Vector3d::Zero()), pointMessage(foot)};
  target.scale.x = 0.001;
  array.markers.push_back(target);

  for (Marker& m : array.markers) {
    if (!figures.is_known) m.action = Marker::DELETE;
    m.color.a = figures.is_known ? m.color.a : 0.0F;
  }
  return array;
}

}  // namespace laparoscope_servo
