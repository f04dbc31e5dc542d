// An instrument's shaft in space: a cylinder, and how far it may be from there. m, in the camera's frame. No ROS, no
// widgets, no Ogre.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "laparoscope_servo/geometry/camera.h"
#include "screen/features/feature_facts.h"
#include "screen/space/space_shapes.h"

namespace laparoscope_servo::screen {

struct InstrumentShape {
  Eigen::Vector3d entry;  // on the axis, where it enters the picture
  Eigen::Vector3d end;    // on the axis: the tip; where sliding is open the place that the image shows of it
  double radius = 0.0;
  // Rings about the axis and lines along it, between which the surface is by twice the standard deviations; beyond the
  // tip by twice that of its place. The turn about the axis is in none of them. Empty: not known.
  Lines spread;
  // Where sliding along the axis is open, dashes beyond the end, which is then not known.
  Lines open_end;
};

// Of a POSE with a radius, and with an outline from entry to tip. Empty when it is none, or not in front of the camera.
std::optional<InstrumentShape> instrumentShape(const geometry::PinholeCamera& camera, const FeatureFact& pose);

}  // namespace laparoscope_servo::screen
