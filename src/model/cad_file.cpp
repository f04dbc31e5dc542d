#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <sstream>

#include "laparoscope_servo/model/cad_model.h"
#include "model/cad_shape.h"
#include "model/cad_words.h"

namespace laparoscope_servo::model {

namespace {

constexpr int kMost = 100000;      // of anything: a count beyond is an error, not a reason to reserve memory
constexpr double kFarthest = 1e3;  // m: as far as an object may be from the camera

using Pair = std::pair<int, int>;

class Reader {
 public:
  Reader(std::istream& stream, const std::string& name) : words_(stream, name) {}

  std::shared_ptr<const CadModel> read() {
    if (words_.next("V1, the version of the format") != "V1") words_.refuse("V1, the version of the format");
    if (words_.peek().rfind("load(", 0) == 0) {
      words_.next("");
      words_.refuse("the number of points: parts in other files are not supported");
    }
    readPoints();
    readLines();
    readFacesFromLines();
    readFacesFromPoints();
    readCylinders();
    readCircles();
    if (!words_.peek().empty()) {
      words_.next("");
      words_.refuse("the end of the file after the circles");
    }
    std::vector<Pair> wires;
    for (std::size_t k = 0; k < lines_.size(); ++k) {
      if (!in_face_[k]) wires.push_back(lines_[k]);
    }
    completeModel(wires, *model_);
    if (!(model_->radius > 0.0)) words_.refuse("nothing to be seen", "lines, faces, cylinders or circles");
    return model_;
  }

 private:
  int count(const std::string& things) { return words_.integer(0, kMost, "the number of " + things); }

  int point(const std::string& whose) {
    const int points = static_cast<int>(model_->points.size());
    if (points == 0) words_.refuse("no points", "a point for the " + whose);
    return words_.integer(0, points - 1, "the index of a point of the " + whose);
  }

  const Eigen::Vector3d& at(int index) const { return model_->points[static_cast<std::size_t>(index)]; }

  void skipSettings() {
    static const char* const kSettings[] = {"name=", "useLod=", "minLineLengthThreshold=", "minPolygonAreaThreshold="};
    for (bool found = true; found;) {
      found = false;
      for (const char* setting : kSettings) {
        if (words_.peek().rfind(setting, 0) != 0) continue;
        words_.next(setting);
        found = true;
      }
    }
  }

  void readPoints() {
    const int points = count("points");
    for (int k = 0; k < points; ++k) {
      Eigen::Vector3d point;
      for (int i = 0; i < 3; ++i) {
        point[i] = words_.number("a finite coordinate of point " + std::to_string(k) + ", m");
        if (!(std::abs(point[i]) < kFarthest))
          words_.refuse("a coordinate of point " + std::to_string(k) + " below 1000 m");
      }
      model_->points.push_back(point);
    }
  }

  void readLines() {
    const int lines = count("lines");
    for (int k = 0; k < lines; ++k) {
      const int a = point("line"), b = point("line");
      if (!((at(a) - at(b)).norm() > 0.0)) words_.refuse("a line without length", "two different points");
      lines_.emplace_back(a, b);
      skipSettings();
    }
    in_face_.assign(lines_.size(), false);
  }

  void addFace(Face&& face) {
    const std::string error = completeFace(model_->points, face);
    if (!error.empty()) words_.refuse(error, "at least three points of one plane, not on one line");
    model_->faces.push_back(std::move(face));
    skipSettings();
  }

  void readFacesFromLines() {
    const int faces = count("faces from lines");
    for (int k = 0; k < faces; ++k) {
      const int lines = words_.integer(3, kMost, "the number of lines of the face");
      if (lines_.empty()) words_.refuse("no lines", "a line for the face");
      std::vector<Pair> of_face;
      for (int i = 0; i < lines; ++i) {
        const int line = words_.integer(0, static_cast<int>(lines_.size()) - 1, "the index of a line of the face");
        of_face.push_back(lines_[static_cast<std::size_t>(line)]);
        in_face_[static_cast<std::size_t>(line)] = true;
      }
      Face face;
      face.points = chain(of_face);
      if (face.points.empty()) words_.refuse("lines that do not join", "lines that go round the face in order");
      addFace(std::move(face));
    }
  }

  void readFacesFromPoints() {
    const int faces = count("faces from points");
    for (int k = 0; k < faces; ++k) {
      const int points = words_.integer(3, kMost, "the number of points of the face");
      Face face;
      for (int i = 0; i < points; ++i) face.points.push_back(point("face"));
      addFace(std::move(face));
    }
  }

  double radius(const std::string& whose) {
    const std::string expected = "a radius of the " + whose + " above 0 m";
    const double value = words_.number(expected);
    if (!(value > 0.0)) words_.refuse(expected);
    if (!(value < kFarthest)) words_.refuse("a radius of the " + whose + " below 1000 m");
    return value;
  }

  void readCylinders() {
    const int cylinders = count("cylinders");
    for (int k = 0; k < cylinders; ++k) {
      Cylinder cylinder;
      cylinder.begin = at(point("cylinder"));
      cylinder.end = at(point("cylinder"));
      if (!((cylinder.end - cylinder.begin).norm() > 0.0)) {
        words_.refuse("an axis without length", "two different points on the cylinder's axis");
      }
      cylinder.radius = radius("cylinder");
      model_->cylinders.push_back(cylinder);
      skipSettings();
    }
  }

  void readCircles() {
    const int circles = count("circles");
    for (int k = 0; k < circles; ++k) {
      Circle circle;
      circle.radius = radius("circle");
      circle.centre = at(point("circle"));
      const Eigen::Vector3d a = at(point("circle")) - circle.centre, b = at(point("circle")) - circle.centre;
      const Eigen::Vector3d normal = a.cross(b);
      if (!(normal.norm() > 1e-6 * a.norm() * b.norm())) {
        words_.refuse("three points on one line", "the centre and two points that span the circle's plane");
      }
      circle.u = a.normalized();
      circle.v = normal.normalized().cross(circle.u);
      model_->circles.push_back(circle);
      skipSettings();
    }
  }

  CadWords words_;
  std::shared_ptr<CadModel> model_ = std::make_shared<CadModel>();
  std::vector<Pair> lines_;
  std::vector<bool> in_face_;
};

}  // namespace

std::shared_ptr<const CadModel> readCadModel(std::istream& stream, const std::string& name) {
  return Reader(stream, name).read();
}

std::shared_ptr<const CadModel> readCadModel(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw CadFileError(path + " cannot be opened, expected a model in ViSP's format .cao");
  return readCadModel(file, path);
}

}  // namespace laparoscope_servo::model
