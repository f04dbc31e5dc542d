#include "model/occluders.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::model {

namespace {

// Of its depth, by which something has to be in front of a point: what touches it does not hide it.
constexpr double kInFront = 1e-3;
constexpr double kOnSurface = 1.01;  // of a tube's radius
constexpr double kNear = 1e-6;       // of the depth, below which a corner lies in the camera's plane or behind it

double squaredDistance(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d d = b - a;
  const double t = std::clamp(d.dot(p - a) / std::max(d.squaredNorm(), 1e-30), 0.0, 1.0);
  return (a + t * d - p).squaredNorm();
}

}  // namespace

void Occluders::reserve(const CadModel& model) {
  polygons_.reserve(model.faces.size());
  std::size_t corners = 0;
  for (const Face& face : model.faces) corners += face.points.size();
  corners_.reserve(corners);
  tubes_.reserve(model.cylinders.size());
}

void Occluders::set(const CadModel& model, const Eigen::Isometry3d& camera_T_object, const std::vector<char>& faces) {
  polygons_.clear();
  corners_.clear();
  tubes_.clear();
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    if (faces[f] == 0) continue;
    const Face& face = model.faces[f];
    Polygon polygon;
    polygon.normal = camera_T_object.linear() * face.normal;
    polygon.distance = polygon.normal.dot(camera_T_object * face.centre);
    polygon.first = corners_.size();
    polygon.count = face.points.size();
    polygon.least.setConstant(1e30);
    polygon.most.setConstant(-1e30);
    bool in_front = true;
    for (const int p : face.points) {
      const Eigen::Vector3d corner = camera_T_object * model.points[static_cast<std::size_t>(p)];
      in_front = in_front && corner.z() > kNear * model.radius;
      corners_.push_back(corner.hnormalized());
      polygon.least = polygon.least.cwiseMin(corners_.back());
      polygon.most = polygon.most.cwiseMax(corners_.back());
    }
    // One that reaches behind the camera has no image; it hides nothing here.
    if (in_front) {
      polygons_.push_back(polygon);
    } else {
      corners_.resize(polygon.first);
    }
  }
  for (const Cylinder& cylinder : model.cylinders) {
    Tube tube;
    tube.begin = camera_T_object * cylinder.begin;
    tube.axis = camera_T_object.linear() * (cylinder.end - cylinder.begin);
    tube.length = tube.axis.norm();
    tube.axis /= tube.length;
    tube.radius = cylinder.radius;
    tubes_.push_back(tube);
  }
}

bool Occluders::hides(const Polygon& polygon, const Eigen::Vector3d& point, const Eigen::Vector2d& at,
                      double margin) const {
  // The ray meets the plane at this share of the way to the point.
  const double toward = polygon.normal.dot(point);
  if (!(toward < 0.0 && polygon.distance / toward < 1.0 - kInFront)) return false;
  if ((at.array() < polygon.least.array() - margin).any() || (at.array() > polygon.most.array() + margin).any()) {
    return false;
  }
  bool inside = false;
  for (std::size_t k = 0; k < polygon.count; ++k) {
    const Eigen::Vector2d& a = corners_[polygon.first + k];
    const Eigen::Vector2d& b = corners_[polygon.first + (k + 1) % polygon.count];
    if (squaredDistance(at, a, b) < margin * margin) return true;
    if ((a.y() > at.y()) != (b.y() > at.y()) && at.x() < a.x() + (at.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
      inside = !inside;
    }
  }
  return inside;
}

bool Occluders::hides(const Tube& tube, const Eigen::Vector3d& point, double margin) const {
  const Eigen::Vector3d d = point - point.dot(tube.axis) * tube.axis;
  const Eigen::Vector3d c = tube.begin - tube.begin.dot(tube.axis) * tube.axis;
  // What lies on the tube itself, as its sides and the circles at its ends do, is not hidden by what is beside it.
  const double out = (point - tube.begin - (point - tube.begin).dot(tube.axis) * tube.axis).norm();
  const double radius = out > kOnSurface * tube.radius ? tube.radius + margin * point.z() : tube.radius;
  // |s d - c| = radius, s from 0 at the camera to 1 at the point.
  const double a = d.squaredNorm(), b = d.dot(c), root = b * b - a * (c.squaredNorm() - radius * radius);
  const auto between = [&](double s) {
    const double along = s * point.dot(tube.axis) - tube.begin.dot(tube.axis);
    return s > 0.0 && s < 1.0 - kInFront && along >= 0.0 && along <= tube.length;
  };
  if (a > 0.0 && root > 0.0) {
    const double s = (b - std::sqrt(root)) / a;
    if (between(s)) return true;
  }
  // The discs at its ends.
  const double slope = point.dot(tube.axis);
  for (const double end : {0.0, tube.length}) {
    const double s = (tube.begin.dot(tube.axis) + end) / slope;
    if (s > 0.0 && s < 1.0 - kInFront && (s * d - c).squaredNorm() < tube.radius * tube.radius) return true;
  }
  return false;
}

bool Occluders::hides(const Eigen::Vector3d& point, double margin) const {
  const Eigen::Vector2d at = point.hnormalized();
  for (const Polygon& polygon : polygons_) {
    if (hides(polygon, point, at, margin)) return true;
  }
  for (const Tube& tube : tubes_) {
    if (hides(tube, point, margin)) return true;
  }
  return false;
}

}  // namespace laparoscope_servo::model
