// The strands of which a model's picture is made: straight edges, the two sides of cylinders, circles. In the camera's
// frame, m.
#pragma once

#include <Eigen/Geometry>

#include "laparoscope_servo/model/cad_model.h"

namespace laparoscope_servo::model {

// Edges come first, then two sides of each cylinder, then circles.
struct Strands {
  explicit Strands(const CadModel& model)
      : edges(static_cast<int>(model.edges.size())),
        sides(2 * static_cast<int>(model.cylinders.size())),
        circles(static_cast<int>(model.circles.size())) {}
  int count() const { return edges + sides + circles; }
  bool isEdge(int strand) const { return strand < edges; }
  bool isCircle(int strand) const { return strand >= edges + sides; }

  int edges, sides, circles;
};

struct Segment {
  Eigen::Vector3d begin = Eigen::Vector3d::Zero();
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
  bool exists = false;

  Eigen::Vector3d at(double along) const { return begin + along * (end - begin); }  // along: 0 to 1
};

Segment edgeSegment(const CadModel& model, const Eigen::Isometry3d& camera_T_object, int edge);

// The line on which rays from the camera touch the cylinder; `side`: 0 or 1. There is none when the camera lies within
// the infinite cylinder.
Segment sideSegment(const Cylinder& cylinder, const Eigen::Isometry3d& camera_T_object, int side);

// Of an edge or a side.
Segment segment(const CadModel& model, const Eigen::Isometry3d& camera_T_object, int strand);

struct CirclePoint {
  Eigen::Vector3d point, first, second;  // and derivatives by the angle
};

// `angle`: rad, from u to v.
CirclePoint circlePoint(const Circle& circle, const Eigen::Isometry3d& camera_T_object, double angle);

// The sine of the angle between the circle's plane and the ray to its centre, 0 to 1.
double circleOpening(const Circle& circle, const Eigen::Isometry3d& camera_T_object);

}  // namespace laparoscope_servo::model
