// A rigid object by what is seen of it: straight edges with the faces beside them, cylinders and circles. Metres, in
// the object's frame.
#pragma once

#include <Eigen/Core>
#include <istream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace laparoscope_servo::model {

// A plane polygon; counter-clockwise as seen from where it can be seen.
struct Face {
  std::vector<int> points;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // of length 1, to where it can be seen from
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // mean of its points
};

struct Edge {
  int begin = 0;
  int end = 0;
  // It is seen where one of them is; none: it is a wire, seen from everywhere.
  std::vector<int> faces;
};

// Only its two sides are seen: its ends are circles, if the file has them.
struct Cylinder {
  Eigen::Vector3d begin = Eigen::Vector3d::Zero();  // both on the axis
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

struct Circle {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d u = Eigen::Vector3d::UnitX();  // u and v span its plane, of length 1 and at a right angle
  Eigen::Vector3d v = Eigen::Vector3d::UnitY();
  double radius = 0.0;
};

struct CadModel {
  std::vector<Eigen::Vector3d> points;
  std::vector<Face> faces;
  std::vector<Edge> edges;  // those between faces that lie in one plane are left out: nothing is seen there
  std::vector<Cylinder> cylinders;
  std::vector<Circle> circles;

  // Of the smallest box about all of it that is parallel to the object's axes.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0.0;  // of a sphere about the centre that holds all of it
  // A convex polyhedron: what a face hides lies on faces that point away.
  bool convex = false;
};

// A file that cannot be used; what() is "NAME, line N: VALUE, expected ...".
class CadFileError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

// Reads ViSP's text format, version 1 (extension .cao): points, lines, faces from lines, faces from points, cylinders,
// circles, each section with its count in front; # begins a comment. The settings of level of detail that may follow a
// primitive (name=, useLod=, minLineLengthThreshold=, minPolygonAreaThreshold=) are read over; load(...) is refused.
// `name`: of the file, for messages. Throws CadFileError.
std::shared_ptr<const CadModel> readCadModel(std::istream& stream, const std::string& name);
// The file at `path`.
std::shared_ptr<const CadModel> readCadModel(const std::string& path);

}  // namespace laparoscope_servo::model
