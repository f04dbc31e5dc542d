#include "laparoscope_servo/model/model_feature_tracker.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/validation/error_report.h"
#include "model/convex_hull.h"

namespace laparoscope_servo::model {

using features::Reason;
using features::State;

namespace {

constexpr Eigen::Index kParameters = 6;

}  // namespace

ModelFeatureTracker::ModelFeatureTracker(std::shared_ptr<const CadModel> model, const ModelConfig& config)
    : model_(std::move(model)), config_(config) {
  validation::throwErrors("model", validate(config));
  if (model_ == nullptr) throw std::invalid_argument("no model, expected one");
  features::summarise(told_, features::reasonText(Reason::kNothingSelected));
}

const features::TrackedFeatures& ModelFeatureTracker::select(const cv::Mat& image, double stamp,
                                                             const features::FeatureSelection& selection,
                                                             const features::FeaturePrior& prior) {
  validation::throwErrors("selection", features::validate(selection, {features::FeatureKind::kPose}));
  if (selection.empty()) throw std::invalid_argument("selection: 0 features, expected at least 1");
  if (!prior.camera) throw std::invalid_argument("no camera, expected its focal lengths and centre (camera_info)");
  std::vector<ModelTracker> trackers;
  for (const features::SelectedFeature& selected : selection) {
    try {
      if (!selected.pose) throw std::invalid_argument("no pose, expected one about which the object is looked for");
      trackers.emplace_back(model_, *prior.camera, config_);
      trackers.back().select(image, stamp, *selected.pose);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(selected.id + ": " + error.what());
    }
  }
  trackers_ = std::move(trackers);
  camera_ = *prior.camera;
  features::begin(told_, selection);
  points_.reserve(static_cast<std::size_t>(config_.edges.max_sites));
  for (features::TrackedFeature& told : told_.features) {
    told.parameters.setZero(kParameters);
    told.covariance.setZero(kParameters, kParameters);
    told.outline.reserve(static_cast<std::size_t>(config_.edges.max_sites) + 1);
    told.sites.reserve(static_cast<std::size_t>(config_.edges.max_sites));
  }
  tell();
  return told_;
}

const features::TrackedFeatures& ModelFeatureTracker::track(const cv::Mat& image, double stamp,
                                                            const features::FeaturePrior& prior) {
  if (!trackers_.empty() && prior.camera && *prior.camera != camera_) {
    end("the camera is another one than that of the selection");
    return told_;
  }
  for (ModelTracker& tracker : trackers_) tracker.track(image, stamp, prior.camera_motion);
  tell();
  return told_;
}

void ModelFeatureTracker::reset() {
  end(features::reasonText(Reason::kReset));
}

void ModelFeatureTracker::end(const char* reason) {
  trackers_.clear();
  told_.features.clear();
  features::summarise(told_, reason);
}

// An image that is not of the sequence ends all of them, since all see the same ones.
void ModelFeatureTracker::tell() {
  for (std::size_t k = 0; k < trackers_.size(); ++k) {
    const ModelResult& result = trackers_[k].result();
    if (result.state == State::kIdle) return end(features::reasonText(result.reason));
    features::TrackedFeature& told = told_.features[k];
    told.state = result.state;
    told.reason.assign(features::reasonText(result.reason));
    told.parameters.head<3>() = result.camera_T_object.translation();
    told.parameters.tail<3>() = geometry::so3Log(result.camera_T_object.linear());
    if (result.state == State::kTracking) {
      told.covariance = result.covariance;
    } else {
      features::setUnknown(told.covariance, kParameters);
    }
    told.share = result.share;
    told.expected_error = result.expected_error;
    const std::vector<features::SiteFinding>& findings = trackers_[k].findings();
    points_.clear();
    for (const features::SiteFinding& finding : findings) points_.push_back(finding.point);
    convexHull(points_, told.outline);
    features::tellSites(findings, told.sites);
  }
  if (!trackers_.empty()) features::summarise(told_, "");
}

}  // namespace laparoscope_servo::model
