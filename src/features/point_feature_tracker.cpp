#include "laparoscope_servo/features/point_feature_tracker.h"

#include <array>
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "laparoscope_servo/features/selection_check.h"
#include "laparoscope_servo/validation/error_report.h"

namespace laparoscope_servo::features {

namespace {

// Of the window, in turn, and back to the first.
const std::array<Eigen::Vector2d, 5> kCorners = {Eigen::Vector2d(-1.0, -1.0), Eigen::Vector2d(1.0, -1.0),
                                                 Eigen::Vector2d(1.0, 1.0), Eigen::Vector2d(-1.0, 1.0),
                                                 Eigen::Vector2d(-1.0, -1.0)};

[[noreturn]] void refuse(const SelectedFeature& feature, const cv::Size& picture) {
  const cv::Rect& region = feature.corners->region;
  std::ostringstream text;
  text << feature.id << ": 0 corners in ";
  if (region.empty()) {
    text << "the picture";
  } else {
    text << "the region of " << region.width << " x " << region.height << " px at (" << region.x << ", " << region.y
         << ')';
  }
  text << ", expected texture without highlights, within " << picture.width << " x " << picture.height << " px";
  throw std::invalid_argument(text.str());
}

// Each point of a selection that also names corners: they are looked for in their picture.
FeatureSelection single(const FeatureSelection& selection, const cv::Mat& image, const PointsConfig& config) {
  FeatureSelection points;
  for (const SelectedFeature& feature : selection) {
    if (!feature.corners) {
      points.push_back(feature);
      continue;
    }
    const cv::Mat& picture = feature.picture.empty() ? image : feature.picture;
    const std::vector<Eigen::Vector2d> corners =
        findCorners(picture, feature.corners->region, feature.corners->count, config);
    if (corners.empty()) refuse(feature, picture.size());
    for (std::size_t k = 0; k < corners.size(); ++k) {
      SelectedFeature point = feature;
      point.id += ' ' + std::to_string(k + 1);
      point.corners.reset();
      point.points = {corners[k]};
      points.push_back(std::move(point));
    }
  }
  return points;
}

// Features whose pictures are one and the same in memory share a group; groups keep the order of the selection, so that
// the points of all groups do, too: those of one picture may lie apart.
struct Grouped {
  std::vector<PointGroup> groups;
  FeatureSelection features;  // in the order of the groups' points
};

Grouped grouped(const FeatureSelection& points) {
  Grouped result;
  std::vector<FeatureSelection> members;
  for (const SelectedFeature& point : points) {
    std::size_t k = 0;
    while (k < result.groups.size() && result.groups[k].picture.data != point.picture.data) ++k;
    if (k == result.groups.size()) {
      result.groups.push_back({point.picture, {}});
      members.emplace_back();
    }
    result.groups[k].places.push_back(point.points.front());
    members[k].push_back(point);
  }
  for (FeatureSelection& each : members) {
    result.features.insert(result.features.end(), each.begin(), each.end());
  }
  return result;
}

}  // namespace

const TrackedFeatures& PointFeatureTracker::select(const cv::Mat& image, double stamp,
                                                   const FeatureSelection& selection, const FeaturePrior&) {
  validation::throwErrors("selection", validate(selection, {FeatureKind::kPoint}, true));
  Grouped chosen = grouped(single(selection, image, config_));
  validation::throwErrors("selection", validate(chosen.features, {FeatureKind::kPoint}, true));
  try {
    tracker_.select(image, stamp, chosen.groups);
  } catch (const RefusedFeature& error) {
    throw std::invalid_argument(chosen.features[error.index()].id + ": " + error.what());
  }
  for (SelectedFeature& feature : chosen.features) {
    if (!feature.picture.empty() && feature.desired.size() == 0) feature.desired = feature.points.front();
  }
  begin(told_, chosen.features);
  for (TrackedFeature& told : told_.features) told.outline.resize(kCorners.size());
  tell();
  return told_;
}

const TrackedFeatures& PointFeatureTracker::track(const cv::Mat& image, double stamp, const FeaturePrior& prior) {
  tracker_.track(image, stamp, prior.motion);
  tell();
  return told_;
}

void PointFeatureTracker::reset() {
  tracker_.reset();
  tell();
}

void PointFeatureTracker::tell() {
  const PointsResult& result = tracker_.result();
  if (result.state == State::kIdle) told_.features.clear();
  for (std::size_t k = 0; k < told_.features.size(); ++k) {
    const PointResult& point = result.points[k];
    TrackedFeature& told = told_.features[k];
    told.state = point.state;
    told.reason = reasonText(point.reason);
    told.parameters = point.place;
    told.covariance = point.covariance;
    told.share = point.state == State::kTracking ? point.share : 0.0;
    told.expected_error = point.expected_error;
    for (std::size_t i = 0; i < kCorners.size(); ++i)
      told.outline[i] = point.place + 0.5 * config_.window * (point.shape * kCorners[i]);
  }
  summarise(told_, reasonText(result.reason));
}

}  // namespace laparoscope_servo::features
