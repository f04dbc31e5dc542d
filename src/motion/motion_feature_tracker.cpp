#include "laparoscope_servo/motion/motion_feature_tracker.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "laparoscope_servo/validation/error_report.h"

namespace laparoscope_servo::motion {

namespace {

using features::State;

constexpr char kUnnamed[] = "motion";

std::optional<geometry::Rectangle> regionOf(const features::SelectedFeature& selected) {
  if (selected.points.empty()) return std::nullopt;
  const Eigen::Vector2d first = selected.points[0].cwiseMin(selected.points[1]);
  const Eigen::Vector2d last = selected.points[0].cwiseMax(selected.points[1]);
  return geometry::Rectangle{first.x(), first.y(), last.x() - first.x() + 1.0, last.y() - first.y() + 1.0};
}

features::SelectedFeature named(const std::string& id) {
  features::SelectedFeature feature;
  feature.id = id;
  feature.kind = features::FeatureKind::kMotion;
  return feature;
}

}  // namespace

MotionFeatureTracker::MotionFeatureTracker(const MotionConfig& config)
    : config_(config), parameters_(parametersOf(config.model)), motion_(config) {
  features::summarise(told_, reasonText(motion_.result().reason));
}

void MotionFeatureTracker::begin(const features::FeatureSelection& selection) {
  features::begin(told_, selection);
  for (features::TrackedFeature& told : told_.features) told.outline.resize(5);
}

const features::TrackedFeatures& MotionFeatureTracker::select(const cv::Mat& image, double stamp,
                                                              const features::FeatureSelection& selection,
                                                              const features::FeaturePrior& prior) {
  validation::throwErrors("selection", validate(selection, {features::FeatureKind::kMotion}));
  if (selection.size() != 1) {
    throw std::invalid_argument("selection: " + std::to_string(selection.size()) +
                                " features, expected 1: the dominant motion");
  }
  const std::string& id = selection[0].id;
  const Eigen::Index desired = selection[0].desired.size();
  if (desired != 0 && desired != parameters_) {
    throw std::invalid_argument(id + ": number of desired values = " + std::to_string(desired) +
                                ", expected one for each of the " + std::to_string(parameters_) +
                                " parameters of the model");
  }
  const std::optional<geometry::Rectangle> region = regionOf(selection[0]);
  try {
    if (region) {
      motion_.begin(image, stamp, region, prior.mask);
      anchored_.reset();
    } else {
      AnchoredMotion anchored(config_);
      anchored.begin(image, stamp, prior.mask);
      anchored_ = std::move(anchored);
    }
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(id + ": " + error.what());
  }
  size_ = image.size();
  features::FeatureSelection all = selection;
  if (anchored_) all.push_back(named(id + " step"));
  begin(all);
  tell();
  return told_;
}

// What was selected ends where another sequence begins.
const features::TrackedFeatures& MotionFeatureTracker::track(const cv::Mat& image, double stamp,
                                                             const features::FeaturePrior& prior) {
  if (anchored_) {
    anchored_->track(image, stamp, prior.motion, prior.mask);
    if (anchored_->step().state == State::kIdle) {
      const char* const reason = reasonText(anchored_->step().reason);
      anchored_.reset();
      motion_.begin(image, stamp, std::nullopt, prior.mask);
      size_ = image.size();
      begin({named(kUnnamed)});
      tell();
      told_.features.front().reason = reason;
      features::summarise(told_, reason);
      return told_;
    }
  } else {
    motion_.track(image, stamp, prior.motion, prior.mask);
    if (motion_.result().state == State::kIdle || told_.features.empty()) begin({named(kUnnamed)});
  }
  size_ = image.size();
  tell();
  return told_;
}

void MotionFeatureTracker::reset() {
  anchored_.reset();
  motion_.reset();
  told_.features.clear();
  features::summarise(told_, reasonText(motion_.result().reason));
}

void MotionFeatureTracker::tell() {
  if (anchored_) {
    tellAnchored(anchored_->result(), told_.features.front());
    tellStep(anchored_->step(), told_.features.back());
  } else {
    tellStep(motion_.result(), told_.features.front());
  }
  features::summarise(told_, told_.features.front().reason);
}

void MotionFeatureTracker::tellStep(const MotionResult& result, features::TrackedFeature& told) const {
  told.state = result.state;
  told.reason = reasonText(result.reason);
  told.share = result.share;
  told.expected_error = result.expected_error;
  if (result.state == State::kIdle) {
    told.parameters.resize(0);
    told.covariance.resize(0, 0);
  } else {
    told.parameters = result.field.a.head(parameters_);
    told.covariance = result.covariance.topLeftCorner(parameters_, parameters_);
  }
  for (std::size_t k = 0; k < told.outline.size(); ++k) told.outline[k] = result.region[k % 4];
}

void MotionFeatureTracker::tellAnchored(const AnchoredResult& result, features::TrackedFeature& told) const {
  told.state = result.state;
  told.reason = reasonText(result.reason);
  told.share = result.share;
  told.expected_error = result.expected_error;
  told.parameters = result.field.a.head(parameters_);
  told.covariance = result.covariance.topLeftCorner(parameters_, parameters_);
  const geometry::Rectangle frame{0.0, 0.0, static_cast<double>(size_.width), static_cast<double>(size_.height)};
  const geometry::Quadrilateral corners = geometry::apply(result.g, frame.corners());
  for (std::size_t k = 0; k < told.outline.size(); ++k) told.outline[k] = corners[k % 4];
}

cv::Mat MotionFeatureTracker::mask() const {
  cv::Mat1b mask = cv::Mat1b::zeros(size_);
  const cv::Mat1b& support = anchored_ ? anchored_->support() : motion_.support();
  const cv::Size cell = anchored_ ? anchored_->cellSize() : motion_.cellSize();
  const cv::Point origin = anchored_ ? cv::Point() : motion_.supportOrigin();
  for (int j = 0; j < support.rows; ++j) {
    for (int i = 0; i < support.cols; ++i) {
      if (support(j, i) != 0) continue;
      const cv::Rect whole(origin.x + i * cell.width, origin.y + j * cell.height, cell.width, cell.height);
      const cv::Rect box = whole & cv::Rect({}, size_);
      if (!box.empty()) mask(box).setTo(255);
    }
  }
  return mask;
}

}  // namespace laparoscope_servo::motion
