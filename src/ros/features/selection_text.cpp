#include "ros/features/selection_text.h"

#include <yaml-cpp/yaml.h>

#include <array>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

#include "laparoscope_servo/features/curve.h"
#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/validation/error_report.h"
#include "ros/common/picture_file.h"

namespace laparoscope_servo {

namespace {

using features::FeatureKind;
using features::SelectedFeature;

constexpr std::array<FeatureKind, 6> kWrittenKinds = {FeatureKind::kPoint,  FeatureKind::kLine,   FeatureKind::kEllipse,
                                                      FeatureKind::kSpline, FeatureKind::kMotion, FeatureKind::kPose};
constexpr char kShapes[] = "one of point, corners, line, ellipse, spline, motion, pose";
constexpr char kKeys[] =
    "id, one of point, corners, line, ellipse, spline, motion, pose, and arc, closed, range, stored, desired";

// Each file is read once, so that features of one file have one picture.
class Pictures {
 public:
  // Empty when it cannot be read.
  cv::Mat read(const std::string& file) {
    const auto known = read_.find(file);
    if (known != read_.end()) return known->second;
    return read_[file] = readPicture(file, cv::IMREAD_COLOR);
  }

 private:
  std::map<std::string, cv::Mat> read_;
};

// Reads one feature, and keeps what is wrong with it.
class Reader {
 public:
  Reader(const YAML::Node& node, Pictures& pictures, std::vector<std::string>& errors)
      : node_(node), pictures_(pictures), errors_(errors) {}

  SelectedFeature read() {
    if (!node_.IsMap()) {
      refuse(node_, "a feature", "{id: ..., line: ...}");
      return feature_;
    }
    if (node_["id"] && node_["id"].IsScalar()) feature_.id = node_["id"].Scalar();
    if (feature_.id.empty()) refuse(node_["id"] ? node_["id"] : node_, "id", "a name");
    readShape();
    refuseTwice(node_);
    for (const auto& entry : node_) readOther(entry.first.Scalar(), entry.second);
    return feature_;
  }

 private:
  void refuse(const YAML::Node& where, const std::string& what, const std::string& expected) {
    std::ostringstream text;
    text << (feature_.id.empty() ? "a feature" : feature_.id) << ", line " << where.Mark().line + 1 << ": " << what;
    if (where.IsScalar()) text << " = " << where.Scalar();
    text << ", expected " << expected;
    errors_.push_back(text.str());
  }

  // Of a key that stands in a map twice yaml-cpp gives the first value.
  void refuseTwice(const YAML::Node& map) {
    std::set<std::string> keys;
    for (const auto& entry : map) {
      if (!keys.insert(entry.first.Scalar()).second) refuse(entry.first, "key", "each key once");
    }
  }

  double number(const YAML::Node& node, const std::string& what) {
    double value = 0.0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value)) refuse(node, what, "a number");
    return value;
  }

  // Two numbers in brackets.
  Eigen::Vector2d pair(const YAML::Node& node, const std::string& what, const std::string& expected) {
    if (!node.IsSequence() || node.size() != 2) {
      refuse(node, what, expected);
      return Eigen::Vector2d::Zero();
    }
    return {number(node[0], what), number(node[1], what)};
  }

  void readPoints(const YAML::Node& node, const std::string& what) {
    if (!node.IsSequence()) return refuse(node, what, "points: [[x, y], [x, y], ...], px");
    for (const YAML::Node& point : node) feature_.points.push_back(pair(point, what, "points of two numbers: [x, y]"));
  }

  void readEllipse(const YAML::Node& node) {
    features::EllipseSelection ellipse;
    if (!node["centre"] || !node["radii"]) refuse(node, "ellipse", "centre: [x, y] and radii: [a, b], px, or points");
    refuseTwice(node);
    for (const auto& entry : node) {
      const std::string key = entry.first.Scalar();
      if (key == "centre") {
        ellipse.centre = pair(entry.second, "centre", "[x, y], px");
      } else if (key == "radii") {
        const Eigen::Vector2d radii = pair(entry.second, "radii", "[a, b], px");
        ellipse.a = radii.x();
        ellipse.b = radii.y();
      } else if (key == "angle") {
        ellipse.angle = number(entry.second, "angle");
      } else {
        refuse(entry.first, "key of an ellipse", "centre, radii or angle");
      }
    }
    feature_.ellipse = ellipse;
  }

  void readCorners(const YAML::Node& node) {
    features::CornerSelection corners;
    if (!node.IsMap()) refuse(node, "corners", "{region: [x, y, width, height], count: ...}, px, each may be left out");
    if (node.IsMap()) refuseTwice(node);
    for (const auto& entry : node) {
      const std::string key = node.IsMap() ? entry.first.Scalar() : "";
      if (key == "region") {
        corners.region = region(entry.second);
      } else if (key == "count") {
        if (!entry.second.IsScalar() || !YAML::convert<int>::decode(entry.second, corners.count))
          refuse(entry.second, "count", "a whole number");
      } else if (!key.empty()) {
        refuse(entry.first, "key of corners", "region or count");
      }
    }
    feature_.corners = corners;
  }

  cv::Rect region(const YAML::Node& node) {
    std::array<int, 4> sides{};
    bool is_region = node.IsSequence() && node.size() == sides.size();
    for (std::size_t k = 0; is_region && k < sides.size(); ++k)
      is_region = node[k].IsScalar() && YAML::convert<int>::decode(node[k], sides[k]) &&
                  std::abs(static_cast<double>(sides[k])) <= features::kFarthest;
    if (!is_region || sides[2] < 1 || sides[3] < 1) {
      refuse(node, "region", "[x, y, width, height] in whole px, width and height of 1 or more");
      return {};
    }
    return {sides[0], sides[1], sides[2], sides[3]};
  }

  void readPicture(const YAML::Node& node) {
    const std::string file = node.IsScalar() ? node.Scalar() : "";
    if (file.empty() || file.front() != '/') return refuse(node, "stored", "the whole path of a picture");
    feature_.picture = pictures_.read(file);
    if (feature_.picture.empty()) refuse(node, "stored", "a picture that can be read: PNG, JPEG, ...");
  }

  // In the order of the parameters of TrackedFeature.
  void readPose(const YAML::Node& node) {
    if (!node.IsSequence() || node.size() != 6)
      return refuse(node, "pose", "six numbers: [x, y, z, and a rotation vector], m and rad");
    geometry::Vector6d numbers;
    for (Eigen::Index k = 0; k < 6; ++k) numbers[k] = number(node[static_cast<std::size_t>(k)], "pose");
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = numbers.head<3>();
    if (numbers.allFinite()) pose.linear() = geometry::so3Exp(numbers.tail<3>());
    feature_.pose = pose;
    if (!numbers.allFinite()) refuse(node, "pose", "finite numbers");
  }

  void readShape() {
    int shapes = 0;
    if (node_["corners"]) {
      ++shapes;
      readCorners(node_["corners"]);
    }
    for (const FeatureKind kind : kWrittenKinds) {
      const YAML::Node shape = node_[features::kindName(kind)];
      if (!shape) continue;
      ++shapes;
      feature_.kind = kind;
      if (kind == FeatureKind::kPoint) {
        feature_.points.push_back(pair(shape, "point", "[x, y], px"));
      } else if (kind == FeatureKind::kPose) {
        readPose(shape);
      } else if (kind == FeatureKind::kEllipse && shape.IsMap()) {
        readEllipse(shape);
      } else {
        readPoints(shape, features::kindName(kind));
      }
    }
    if (shapes != 1) refuse(node_, "its " + std::to_string(shapes) + " shapes", kShapes);
  }

  void readOther(const std::string& key, const YAML::Node& value) {
    if (key == "id" || key == "corners") return;
    for (const FeatureKind kind : kWrittenKinds) {
      if (key == features::kindName(kind)) return;
    }
    if (key == "range") {
      feature_.range = number(value, "range");
    } else if (key == "stored") {
      readPicture(value);
    } else if (key == "closed") {
      if (!value.IsScalar() || !YAML::convert<bool>::decode(value, feature_.closed))
        refuse(value, "closed", "true or false");
    } else if (key == "arc") {
      const Eigen::Vector2d arc = pair(value, "arc", "[begin, extent], rad");
      feature_.arc = features::ArcSelection{arc.x(), arc.y()};
    } else if (key == "desired") {
      if (!value.IsSequence()) return refuse(value, "desired", "a number for each parameter: [...]");
      feature_.desired.resize(static_cast<Eigen::Index>(value.size()));
      for (std::size_t k = 0; k < value.size(); ++k)
        feature_.desired[static_cast<Eigen::Index>(k)] = number(value[k], "desired");
    } else {
      refuse(value, "key " + key, kKeys);
    }
  }

  const YAML::Node node_;
  Pictures& pictures_;
  std::vector<std::string>& errors_;
  SelectedFeature feature_;
};

// yaml-cpp before 0.7 goes down without limit, until its stack ends.
bool isNestedTooDeep(const std::string& text) {
  constexpr int kDeepest = 32;    // a selection has four
  int brackets = 0, entries = 0;  // those that are open; "- " of one line, each an entry of the one before
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (c == '[' || c == '{') ++brackets;
    if (c == ']' || c == '}') --brackets;
    if (c == '\n') entries = 0;
    if ((c == '-' || c == '?') && k + 1 < text.size() && text[k + 1] == ' ') ++entries;
    if (brackets > kDeepest || entries > kDeepest) return true;
  }
  return false;
}

}  // namespace

features::FeatureSelection parseSelection(const std::string& text) {
  if (isNestedTooDeep(text))
    throw std::invalid_argument("selection: nested more than 32 deep, expected a list of features");
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw std::invalid_argument(std::string("selection: ") + error.what());
  }
  if (!root.IsSequence() || root.size() == 0)
    throw std::invalid_argument("selection: no list of features, expected [{id: shaft, line: [[x, y], [x, y]]}, ...]");
  features::FeatureSelection selection;
  std::vector<std::string> errors;
  Pictures pictures;
  for (const YAML::Node& node : root) selection.push_back(Reader(node, pictures, errors).read());
  validation::throwErrors("selection", errors);
  return selection;
}

features::FeatureSelection readSelection(const std::string& file) {
  const std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw std::invalid_argument("selection file '" + file + "' cannot be read");
  try {
    return parseSelection(text.str());
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("'" + file + "': " + error.what());
  }
}

}  // namespace laparoscope_servo
