#include "laparoscope_servo/model/instrument_feature_tracker.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace laparoscope_servo::model {

namespace {

using features::FeatureKind;
using features::State;
using features::TrackedFeature;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr char kNone[] = "no instrument is seen";

}  // namespace

InstrumentFeatureTracker::InstrumentFeatureTracker(const InstrumentConfig& config)
    : tracker_(config), radius_(config.radius) {
  features::summarise(told_, kNone);
}

const features::TrackedFeatures& InstrumentFeatureTracker::select(const cv::Mat&, double,
                                                                  const features::FeatureSelection& selection,
                                                                  const features::FeaturePrior&) {
  throw std::invalid_argument("selection: " + std::to_string(selection.size()) +
                              " features, expected none: instruments are found without a selection");
}

const features::TrackedFeatures& InstrumentFeatureTracker::track(const cv::Mat& image, double stamp,
                                                                 const features::FeaturePrior& prior) {
  tracker_.setCamera(prior.camera);
  tracker_.track(image, stamp, prior.motion);
  tell();
  return told_;
}

void InstrumentFeatureTracker::reset() {
  tracker_.reset();
  told_.features.clear();
  features::summarise(told_, reasonText(features::Reason::kReset));
}

void InstrumentFeatureTracker::tell() {
  count_ = 0;
  for (const Instrument& instrument : tracker_.result().instruments) {
    for (std::size_t side = 0; side < instrument.edges.size(); ++side) addEdge(instrument, side);
    addTip(instrument);
    addPose(instrument);
  }
  told_.features.resize(count_);
  features::summarise(told_, kNone);
}

// Without parameters, and as uncertain as what is not seen. Where there was one in the image before, its memory serves.
TrackedFeature& InstrumentFeatureTracker::add(const Instrument& instrument, const char* part, FeatureKind kind) {
  if (count_ == told_.features.size()) told_.features.emplace_back();
  TrackedFeature& told = told_.features[count_++];
  told.id = std::to_string(instrument.id);
  told.id += part;
  told.kind = kind;
  told.state = instrument.state;
  told.reason = reasonText(instrument.reason);
  told.share = 0.0;
  told.expected_error = kInfinite;
  told.outline.clear();
  told.radius = 0.0;
  told.sites.clear();
  return told;
}

void InstrumentFeatureTracker::addEdge(const Instrument& instrument, std::size_t side) {
  const InstrumentEdge& edge = instrument.edges[side];
  if (!edge.seen) return;
  TrackedFeature& told = add(instrument, side == 0 ? " right" : " left", FeatureKind::kLine);
  told.parameters = Eigen::Vector2d(edge.rho, edge.theta);
  features::setUnknown(told.covariance, 2);
  told.share = edge.fine ? 1.0 : 0.0;
  told.outline.assign({edge.begin, edge.end});
  told.sites.reserve(edge.sites.capacity());
  told.sites.assign(edge.sites.begin(), edge.sites.end());
  if (told.state != State::kTracking) return;
  told.covariance = edge.covariance;
  told.expected_error = edge.expected_error;
}

void InstrumentFeatureTracker::addTip(const Instrument& instrument) {
  TrackedFeature& told = add(instrument, " tip", FeatureKind::kPoint);
  told.parameters = instrument.tip;
  features::setUnknown(told.covariance, 2);
  told.outline.assign({instrument.tip});
  if (told.state != State::kTracking || !std::isfinite(instrument.tip_error + instrument.expected_error)) return;
  const Eigen::Vector2d across(-instrument.axis.y(), instrument.axis.x());
  told.covariance = instrument.tip_error * instrument.tip_error * instrument.axis * instrument.axis.transpose() +
                    instrument.expected_error * instrument.expected_error * across * across.transpose();
  told.share = 1.0;
  told.expected_error = std::max(instrument.tip_error, instrument.expected_error);
}

void InstrumentFeatureTracker::addPose(const Instrument& instrument) {
  if (!instrument.pose) return;
  TrackedFeature& told = add(instrument, "", FeatureKind::kPose);
  const CylinderPose& pose = *instrument.pose;
  const Eigen::AngleAxisd turn(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), pose.direction));
  told.parameters.resize(6);
  told.parameters << pose.point, turn.angle() * turn.axis();
  features::setUnknown(told.covariance, 6);
  told.outline.assign({instrument.entry, instrument.tip});
  told.radius = radius_;
  if (told.state != State::kTracking) return;
  told.covariance = pose.covariance;
  told.share = 1.0;
  told.expected_error = instrument.expected_error;
}

}  // namespace laparoscope_servo::model
