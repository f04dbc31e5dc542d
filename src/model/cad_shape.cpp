#include "model/cad_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace laparoscope_servo::model {

namespace {

constexpr double kFlat = 0.05;           // of a face's size, by which its points may leave its plane
constexpr double kOnePlane = 0.9998477;  // cos(1 deg): faces that differ by less have no edge between them
constexpr double kBehind = 1e-6;         // of the model's size, by which its points may stand out of a convex one

using Pair = std::pair<int, int>;

Pair ordered(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

// The two faces lie on one plane, and share an edge that is therefore not seen.
bool isSeam(const CadModel& model, const Edge& edge) {
  if (edge.faces.size() != 2) return false;
  const auto& faces = model.faces;
  const Eigen::Vector3d& a = faces[static_cast<std::size_t>(edge.faces[0])].normal;
  return a.dot(faces[static_cast<std::size_t>(edge.faces[1])].normal) > kOnePlane;
}

bool isConvex(const CadModel& model, bool closed) {
  if (!closed || model.faces.empty() || !model.cylinders.empty() || !model.circles.empty()) return false;
  for (const Face& face : model.faces) {
    for (const Eigen::Vector3d& point : model.points) {
      if (face.normal.dot(point - face.centre) > kBehind * model.radius) return false;
    }
  }
  return true;
}

}  // namespace

std::string completeFace(const std::vector<Eigen::Vector3d>& points, Face& face) {
  face.centre.setZero();
  for (const int p : face.points) face.centre += points[static_cast<std::size_t>(p)];
  face.centre /= static_cast<double>(face.points.size());
  // Newell: twice the area, also of a polygon that is not convex.
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  double size = 0.0;
  int alike = -1;
  for (std::size_t k = 0; k < face.points.size(); ++k) {
    const Eigen::Vector3d a = points[static_cast<std::size_t>(face.points[k])] - face.centre;
    const Eigen::Vector3d b = points[static_cast<std::size_t>(face.points[(k + 1) % face.points.size()])] - face.centre;
    if (a == b) alike = face.points[k];
    area += a.cross(b);
    size = std::max(size, a.norm());
  }
  if (!(area.norm() > 1e-6 * size * size)) return "a face without area";
  if (alike >= 0) return "a face whose side from point " + std::to_string(alike) + " has no length";
  face.normal = area.normalized();
  for (const int p : face.points) {
    const double out = face.normal.dot(points[static_cast<std::size_t>(p)] - face.centre);
    if (!(std::abs(out) <= kFlat * size)) return "a face whose point " + std::to_string(p) + " is not in its plane";
  }
  return "";
}

std::vector<int> chain(const std::vector<Pair>& lines) {
  if (lines.size() < 3) return {};
  const auto [a, b] = lines[0];
  const auto has = [&](std::size_t k, int p) { return lines[k].first == p || lines[k].second == p; };
  std::vector<int> points{has(1, b) ? a : b};
  int here = points[0] == a ? b : a;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    if (!has(k, here)) return {};
    points.push_back(here);
    here = lines[k].first == here ? lines[k].second : lines[k].first;
  }
  return here == points[0] ? points : std::vector<int>{};
}

void completeModel(const std::vector<Pair>& wires, CadModel& model) {
  std::map<Pair, std::vector<int>> faces_of;
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const std::vector<int>& points = model.faces[f].points;
    for (std::size_t k = 0; k < points.size(); ++k) {
      faces_of[ordered(points[k], points[(k + 1) % points.size()])].push_back(static_cast<int>(f));
    }
  }
  for (const Pair& wire : wires) faces_of[ordered(wire.first, wire.second)];
  bool closed = true;
  for (const auto& [ends, faces] : faces_of) {
    Edge edge;
    edge.begin = ends.first;
    edge.end = ends.second;
    edge.faces = faces;
    closed = closed && faces.size() == 2;
    if (!isSeam(model, edge)) model.edges.push_back(edge);
  }

  Eigen::AlignedBox3d box;
  const auto add = [&box](const Eigen::Vector3d& centre, double radius) {
    box.extend(centre - Eigen::Vector3d::Constant(radius));
    box.extend(centre + Eigen::Vector3d::Constant(radius));
  };
  for (const Edge& edge : model.edges) {
    for (const int p : {edge.begin, edge.end}) box.extend(model.points[static_cast<std::size_t>(p)]);
  }
  for (const Cylinder& cylinder : model.cylinders) {
    for (const Eigen::Vector3d& end : {cylinder.begin, cylinder.end}) add(end, cylinder.radius);
  }
  for (const Circle& circle : model.circles) add(circle.centre, circle.radius);
  if (box.isEmpty()) return;
  model.centre = box.center();
  model.radius = 0.5 * box.diagonal().norm();
  model.convex = isConvex(model, closed);
}

}  // namespace laparoscope_servo::model
