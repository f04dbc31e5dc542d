#include "laparoscope_servo/features/tracked_feature.h"

#include "laparoscope_servo/features/curve.h"

namespace laparoscope_servo::features {

const char* kindName(FeatureKind kind) {
  switch (kind) {
    case FeatureKind::kPoint:
      return "point";
    case FeatureKind::kLine:
      return "line";
    case FeatureKind::kEllipse:
      return "ellipse";
    case FeatureKind::kSpline:
      return "spline";
    case FeatureKind::kPose:
      return "pose";
    case FeatureKind::kMotion:
      return "motion";
    case FeatureKind::kHomography:
      return "homography";
  }
  return "";
}

void setUnknown(Eigen::MatrixXd& covariance, Eigen::Index count) {
  covariance.resize(count, count);
  setUnknown(covariance);
}

void tellSites(const std::vector<SiteFinding>& findings, std::vector<TrackedSite>& sites) {
  sites.clear();
  for (const SiteFinding& finding : findings) {
    if (finding.inside && !finding.probe) sites.push_back({finding.point, finding.weight});
  }
}

void summarise(TrackedFeatures& all, std::string_view why_none) {
  all.state = State::kIdle;
  all.reason = why_none;
  for (const TrackedFeature& feature : all.features) {
    if (static_cast<int>(feature.state) <= static_cast<int>(all.state)) continue;
    all.state = feature.state;
    all.reason.clear();
    if (feature.reason.empty()) continue;
    all.reason.append(feature.id).append(": ").append(feature.reason);
  }
}

}  // namespace laparoscope_servo::features
