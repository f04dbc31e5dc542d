#include "laparoscope_servo/tracking/contour_texture.h"

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "laparoscope_servo/features/edge_fit.h"
#include "laparoscope_servo/features/image_sequence.h"
#include "laparoscope_servo/features/selection_check.h"
#include "laparoscope_servo/features/spline.h"
#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/image_type.h"
#include "laparoscope_servo/validation/error_report.h"
#include "tracking/contour_texture/contour_fit.h"
#include "tracking/motion_filter.h"

namespace laparoscope_servo::tracking {

namespace {

using features::Reason;

constexpr int kOutlinePoints = 100;
constexpr double kMostlySeen = 0.6;  // share, from which on an image tells how much motions differ from predicted ones

features::Spline splineOf(const cv::Mat& image, const features::SelectedFeature& selected,
                          const ContourTextureConfig& config, double& share) {
  features::Spline contour = features::Spline::throughPoints(selected.points, true);
  features::EdgeFit fit(config.edges);
  const features::EdgeReport report = fit.learn(image, contour, selected.range);
  share = report.share;
  if (report.reason == Reason::kNone) return contour;
  if (config.contour) {
    std::ostringstream text;
    text.precision(3);
    text << "no such edge in the image: " << reasonText(report.reason) << " (" << report.used << " of " << report.inside
         << " sites in the image agree, expected half of them)";
    throw std::invalid_argument(text.str());
  }
  return features::Spline::throughPoints(selected.points, true);
}

// Of the eight parameters that are told, by the step x of G (see MotionPrior) at `g`: each column of G A_k, over h22.
Matrix8d parametersByStep(const Eigen::Matrix3d& g, const Eigen::Matrix3d& n) {
  Matrix8d result;
  const Eigen::Matrix3d h = g / g(2, 2);
  for (int k = 0; k < 8; ++k) {
    const Eigen::Matrix3d d = g * n.inverse() * geometry::sl3Hat(geometry::Vector8d::Unit(k)) * n;
    const Eigen::Matrix3d e = (d - h * d(2, 2)) / g(2, 2);
    result.col(k) << e(0, 0), e(0, 1), e(0, 2), e(1, 0), e(1, 1), e(1, 2), e(2, 0), e(2, 1);
  }
  return result;
}

}  // namespace

class ContourTextureTracker::Implementation {
 public:
  explicit Implementation(const ContourTextureConfig& config)
      : config_(config), keeper_(config.edges.state), filter_(config.edges.velocity_damping), fit_(config) {
    features::summarise(told_, reasonText(Reason::kNothingSelected));
  }

  void select(const cv::Mat& image, double stamp, const features::SelectedFeature& selected);
  void track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion);
  void reset(Reason reason);
  const features::TrackedFeatures& told() const { return told_; }

 private:
  void tell(const ContourEstimate& estimate);

  ContourTextureConfig config_;
  features::TrackedFeatures told_;
  features::StateKeeper keeper_;
  MotionFilter filter_;
  ContourFit fit_;
  EsmState last_;  // last estimate that was believed, or has to be confirmed
  features::ImageSequence sequence_;
};

void ContourTextureTracker::Implementation::select(const cv::Mat& image, double stamp,
                                                   const features::SelectedFeature& selected) {
  Implementation fresh(config_);
  ContourEstimate seen;
  fresh.fit_.setReference(image, splineOf(image, selected, config_, seen.share));
  fresh.filter_.start(fresh.fit_.roi(), fresh.fit_.normalisation(), stamp);
  fresh.keeper_.select(stamp);
  fresh.sequence_.begin(image, stamp);
  features::begin(fresh.told_, {selected});
  fresh.told_.features[0].kind = features::FeatureKind::kHomography;
  *this = std::move(fresh);
  seen.esm.corner_error = fit_.referenceCornerError();
  tell(seen);
}

void ContourTextureTracker::Implementation::track(const cv::Mat& image, double stamp,
                                                  const std::optional<Eigen::Matrix3d>& motion) {
  const Reason ended = sequence_.judge(image, stamp);
  if (keeper_.state() == features::State::kIdle) return;
  if (ended != Reason::kNone) return reset(ended);
  sequence_.goOn(stamp);
  const bool tracking = keeper_.state() == features::State::kTracking;
  std::optional<Eigen::Matrix3d> carried;
  if (motion && motion->allFinite() && motion->determinant() > 1e-12)
    carried = geometry::normaliseDeterminant(*motion * last_.g);
  if (carried && !geometry::isConvex(geometry::apply(*carried, fit_.roi().corners()))) carried.reset();
  const MotionPrior prior = filter_.predict(stamp, carried);
  EsmState start = last_;
  start.g = prior.predicted;
  const double min_share = tracking ? config_.edges.min_share : config_.edges.min_return_share;
  ContourEstimate best = fit_.align(image, start, tracking ? &prior : nullptr, min_share);
  if (best.reason != Reason::kNone) {
    if (const std::optional<Eigen::Matrix3d> elsewhere = fit_.elsewhere(image, start.g)) {
      start.g = *elsewhere;
      fit_.forget();
      best = fit_.align(image, start, nullptr, min_share);
    }
  }
  keeper_.step(best.reason, stamp);
  if (best.reason != Reason::kNone) {
    filter_.stop();
    fit_.forget();
  } else {
    if (tracking) {
      filter_.update(prior, best.esm, stamp, best.share >= kMostlySeen, carried);
    } else {
      filter_.restart(best.esm, stamp);
    }
    last_ = best.esm.state;
    if (keeper_.state() == features::State::kTracking) fit_.remember(last_);
  }
  tell(best);
}

void ContourTextureTracker::Implementation::reset(Reason reason) {
  keeper_.reset(reason);
  told_.features.clear();
  features::summarise(told_, reasonText(reason));
}

void ContourTextureTracker::Implementation::tell(const ContourEstimate& estimate) {
  features::TrackedFeature& told = told_.features[0];
  told.state = keeper_.state();
  told.reason = reasonText(keeper_.reason());
  told.share = estimate.share;
  const Eigen::Matrix3d h = last_.g / last_.g(2, 2);
  told.parameters.resize(8);
  told.parameters << h(0, 0), h(0, 1), h(0, 2), h(1, 0), h(1, 1), h(1, 2), h(2, 0), h(2, 1);
  told.outline.resize(kOutlinePoints + 1);
  for (int k = 0; k <= kOutlinePoints; ++k) {
    const int slot = k * (Outline::kSlots / kOutlinePoints) % Outline::kSlots;
    told.outline[static_cast<std::size_t>(k)] = geometry::apply(last_.g, fit_.outline().point(slot));
  }
  if (told.state == features::State::kTracking) {
    const Matrix8d by_step = parametersByStep(last_.g, fit_.normalisation());
    told.covariance = by_step * estimate.esm.covariance * by_step.transpose();
    told.expected_error = estimate.esm.corner_error;
  } else {
    features::setUnknown(told.covariance, 8);
    told.expected_error = std::numeric_limits<double>::infinity();
  }
  features::tellSites(fit_.findings(), told.sites);
  features::summarise(told_, "");
}

ContourTextureTracker::ContourTextureTracker(const ContourTextureConfig& config) {
  validation::throwErrors("contour", validate(config));
  implementation_ = std::make_unique<Implementation>(config);
}
ContourTextureTracker::~ContourTextureTracker() = default;

const features::TrackedFeatures& ContourTextureTracker::select(const cv::Mat& image, double stamp,
                                                               const features::FeatureSelection& selection,
                                                               const features::FeaturePrior&) {
  image::checkImage(image, stamp);
  validation::throwErrors("selection", features::validate(selection, {features::FeatureKind::kSpline}));
  if (selection.size() != 1)
    throw std::invalid_argument("selection: " + std::to_string(selection.size()) + " features, expected 1");
  if (!selection[0].closed)
    throw std::invalid_argument(selection[0].id + ": closed = false, expected true: a contour that has an inside");
  try {
    features::checkInImage(selection[0], image.size());
    implementation_->select(image, stamp, selection[0]);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(selection[0].id + ": " + error.what());
  }
  return implementation_->told();
}

const features::TrackedFeatures& ContourTextureTracker::track(const cv::Mat& image, double stamp,
                                                              const features::FeaturePrior& prior) {
  implementation_->track(image, stamp, prior.motion);
  return implementation_->told();
}

void ContourTextureTracker::reset() {
  implementation_->reset(Reason::kReset);
}

const features::TrackedFeatures& ContourTextureTracker::features() const {
  return implementation_->told();
}

}  // namespace laparoscope_servo::tracking
