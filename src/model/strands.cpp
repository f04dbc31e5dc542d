#include "model/strands.h"

#include <cmath>

namespace laparoscope_servo::model {

Segment edgeSegment(const CadModel& model, const Eigen::Isometry3d& camera_T_object, int edge) {
  const Edge& e = model.edges[static_cast<std::size_t>(edge)];
  return {camera_T_object * model.points[static_cast<std::size_t>(e.begin)],
          camera_T_object * model.points[static_cast<std::size_t>(e.end)], true};
}

// A point A + r c of the surface, c of length 1 and across the axis, is on the outline when its normal c is across the
// ray: c . (a + r c) = 0, a being A less its part along the axis. So c . a = -r, and c = -(r / d) e +- sqrt(1 - (r /
// d)^2) (u x e), d = |a|, e = a / d.
Segment sideSegment(const Cylinder& cylinder, const Eigen::Isometry3d& camera_T_object, int side) {
  Segment result;
  const Eigen::Vector3d begin = camera_T_object * cylinder.begin, end = camera_T_object * cylinder.end;
  const Eigen::Vector3d u = (end - begin).normalized();
  const Eigen::Vector3d a = begin - begin.dot(u) * u;
  const double d = a.norm(), share = cylinder.radius / d;
  if (!(share < 1.0)) return result;
  const Eigen::Vector3d e = a / d;
  const double across = std::sqrt(1.0 - share * share) * (side == 0 ? 1.0 : -1.0);
  const Eigen::Vector3d out = cylinder.radius * (-share * e + across * u.cross(e));
  return {begin + out, end + out, true};
}

Segment segment(const CadModel& model, const Eigen::Isometry3d& camera_T_object, int strand) {
  const Strands strands(model);
  if (strands.isEdge(strand)) return edgeSegment(model, camera_T_object, strand);
  const int side = strand - strands.edges;
  return sideSegment(model.cylinders[static_cast<std::size_t>(side / 2)], camera_T_object, side % 2);
}

CirclePoint circlePoint(const Circle& circle, const Eigen::Isometry3d& camera_T_object, double angle) {
  const double c = circle.radius * std::cos(angle), s = circle.radius * std::sin(angle);
  const Eigen::Matrix3d& r = camera_T_object.linear();
  const Eigen::Vector3d out = r * (c * circle.u + s * circle.v);
  return {camera_T_object * circle.centre + out, r * (c * circle.v - s * circle.u), -out};
}

double circleOpening(const Circle& circle, const Eigen::Isometry3d& camera_T_object) {
  const Eigen::Vector3d normal = camera_T_object.linear() * circle.u.cross(circle.v);
  return std::abs(normal.dot((camera_T_object * circle.centre).normalized()));
}

}  // namespace laparoscope_servo::model
