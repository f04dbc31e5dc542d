#include "laparoscope_servo/features/feature_selection.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "laparoscope_servo/features/curve.h"

namespace laparoscope_servo::features {

namespace {

constexpr double kLeastRange = 1.0;  // px
constexpr double kMostRange = 100.0;
constexpr int kAnyNumber = -1;
constexpr double kFarthestPose = 1e3;  // m
constexpr int kMostCorners = 500;

// Of the parameters, see FeatureKind.
int parametersOf(FeatureKind kind) {
  switch (kind) {
    case FeatureKind::kPoint:
    case FeatureKind::kLine:
      return 2;
    case FeatureKind::kEllipse:
      return 5;
    case FeatureKind::kPose:
      return 6;
    default:
      return kAnyNumber;
  }
}

std::string listed(const std::vector<FeatureKind>& kinds) {
  std::string text;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    if (k > 0) text += k + 1 == kinds.size() ? " or " : ", ";
    text += kindName(kinds[k]);
  }
  return text;
}

class Judge {
 public:
  Judge(const SelectedFeature& feature, bool takes_corners_and_pictures)
      : feature_(feature), takes_corners_and_pictures_(takes_corners_and_pictures) {}

  template <class Value>
  void refuse(const std::string& what, const Value& value, const std::string& expected) {
    std::ostringstream text;
    text << feature_.id << ": " << what << " = " << value << ", expected " << expected;
    errors_.push_back(text.str());
  }

  void finite(const std::string& what, double value) {
    if (!std::isfinite(value)) refuse(what, value, "a finite number");
  }

  void place(const std::string& what, double value) {
    finite(what, value);
    if (std::abs(value) >= kFarthest && std::isfinite(value)) refuse(what, value, "a number below 100000 px");
  }

  void all() {
    for (const Eigen::Vector2d& point : feature_.points) {
      if (!point.allFinite()) {
        refuse("point", pointText(point), "two finite numbers, px");
      } else if (!(point.lpNorm<Eigen::Infinity>() < kFarthest)) {
        refuse("point", pointText(point), "two numbers below 100000 px");
      }
    }
    if (!(feature_.range >= kLeastRange && feature_.range <= kMostRange))
      refuse("range", feature_.range, "1 to 100 px");
    number();
    shape();
    pose();
    corners();
    const int wanted = parametersOf(feature_.kind);
    const Eigen::Index given = feature_.desired.size();
    if (given > 0 && wanted != kAnyNumber && given != wanted) {
      refuse("number of desired values", given,
             "one for each of the " + std::to_string(wanted) + " parameters of a " + kindName(feature_.kind));
    }
    for (Eigen::Index k = 0; k < given; ++k) finite("desired value", feature_.desired[k]);
  }

  const std::vector<std::string>& errors() const { return errors_; }

 private:
  static std::string pointText(const Eigen::Vector2d& point) {
    std::ostringstream text;
    text << '[' << point.x() << ", " << point.y() << ']';
    return text.str();
  }

  void number() {
    const std::size_t given = feature_.points.size();
    const FeatureKind kind = feature_.kind;
    if (kind == FeatureKind::kPoint && feature_.corners && given > 0) {
      refuse("number of points", given, "0 beside corners");
    } else if (kind == FeatureKind::kPoint && !feature_.corners && given != 1) {
      refuse("number of points", given, "1: where it is");
    }
    if (kind == FeatureKind::kLine && given != 2) refuse("number of points", given, "2: the line's ends");
    if (kind == FeatureKind::kMotion && given != 0 && given != 2)
      refuse("number of points", given, "0, or 2: opposite corners of a region");
    const std::size_t least = feature_.closed ? 4 : 3;
    if (kind == FeatureKind::kSpline && given < least) {
      refuse("number of points", given, std::to_string(least) + " or more on the spline");
    }
    if (kind != FeatureKind::kEllipse) return;
    if (feature_.ellipse && given > 0) refuse("number of points", given, "0 beside centre and radii");
    if (!feature_.ellipse && given < 5) refuse("number of points", given, "5 or more, or centre and radii");
  }

  void shape() {
    if (feature_.ellipse) {
      if (feature_.kind != FeatureKind::kEllipse) refuse("kind", kindName(feature_.kind), "ellipse beside radii");
      place("centre, x", feature_.ellipse->centre.x());
      place("centre, y", feature_.ellipse->centre.y());
      finite("angle", feature_.ellipse->angle);
      for (const double radius : {feature_.ellipse->a, feature_.ellipse->b}) {
        if (!(radius > 0.0 && std::isfinite(radius))) refuse("radius", radius, "a positive number, px");
      }
    }
    if (feature_.closed && feature_.kind != FeatureKind::kSpline) {
      refuse("kind", kindName(feature_.kind), "spline, if closed");
    }
    if (!feature_.arc) return;
    if (feature_.kind != FeatureKind::kEllipse) refuse("kind", kindName(feature_.kind), "ellipse beside an arc");
    finite("begin of the arc", feature_.arc->begin);
    finite("extent of the arc", feature_.arc->extent);
  }

  void pose() {
    if (!feature_.pose) return;
    if (feature_.kind != FeatureKind::kPose) refuse("kind", kindName(feature_.kind), "pose beside a pose");
    for (const double value :
         {feature_.pose->translation().x(), feature_.pose->translation().y(), feature_.pose->translation().z()}) {
      if (!(std::abs(value) < kFarthestPose)) refuse("position", value, "a number below 1000 m");
    }
    if (!feature_.pose->linear().allFinite()) refuse("rotation", "nan", "a rotation vector of finite numbers, rad");
  }

  void corners() {
    const bool is_point = feature_.kind == FeatureKind::kPoint;
    if (!feature_.picture.empty() && !(is_point && takes_corners_and_pictures_))
      refuse("stored picture", std::to_string(feature_.picture.cols) + " x " + std::to_string(feature_.picture.rows),
             "none: only the tracker of points takes one");
    if (!feature_.corners) return;
    if (!(is_point && takes_corners_and_pictures_))
      refuse("number of corners", feature_.corners->count, "none: only the tracker of points chooses some");
    if (feature_.corners->count < 1 || feature_.corners->count > kMostCorners)
      refuse("number of corners", feature_.corners->count, "1 to " + std::to_string(kMostCorners));
    if (feature_.desired.size() > 0)
      refuse("number of desired values", feature_.desired.size(), "0 beside corners: nobody knows them one by one");
  }

  const SelectedFeature& feature_;
  bool takes_corners_and_pictures_;
  std::vector<std::string> errors_;
};

}  // namespace

std::vector<std::string> validate(const FeatureSelection& selection, const std::vector<FeatureKind>& kinds,
                                  bool takes_corners_and_pictures) {
  std::vector<std::string> errors;
  for (std::size_t k = 0; k < selection.size(); ++k) {
    const SelectedFeature& feature = selection[k];
    Judge judge(feature, takes_corners_and_pictures);
    if (feature.id.empty()) {
      errors.push_back("feature " + std::to_string(k + 1) + " has no id, expected a name");
    } else if (std::any_of(selection.begin(), selection.begin() + static_cast<std::ptrdiff_t>(k),
                           [&](const SelectedFeature& other) { return other.id == feature.id; })) {
      judge.refuse("id", feature.id, "an id that no other feature has");
    }
    if (std::find(kinds.begin(), kinds.end(), feature.kind) == kinds.end()) {
      judge.refuse("kind", kindName(feature.kind), listed(kinds) + " of this tracker");
    } else {
      judge.all();
    }
    errors.insert(errors.end(), judge.errors().begin(), judge.errors().end());
  }
  return errors;
}

void begin(TrackedFeatures& told, const FeatureSelection& selection) {
  constexpr std::size_t kReasonLength = 160;  // more than any text has
  told.features.assign(selection.size(), {});
  told.reason.reserve(2 * kReasonLength);
  for (std::size_t k = 0; k < selection.size(); ++k) {
    TrackedFeature& feature = told.features[k];
    feature.id = selection[k].id;
    feature.kind = selection[k].kind;
    feature.desired = selection[k].desired;
    feature.reason.reserve(kReasonLength);
  }
}

}  // namespace laparoscope_servo::features
