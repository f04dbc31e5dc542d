// What every tracker of features says of each of them: one form for messages, tables and overlays.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "laparoscope_servo/features/feature_state.h"

namespace laparoscope_servo::features {

struct SiteFinding;

// What the parameters of a feature are. Pixels: the centre of the first one is (0, 0), x to the right, y down.
enum class FeatureKind {
  kPoint = 0,    // x, y: px
  kLine = 1,     // rho px, theta rad: x cos(theta) + y sin(theta) = rho
  kEllipse = 2,  // K1 to K5: x^2 + K1 y^2 + 2 K2 x y + 2 K3 x + 2 K4 y + K5 = 0, x and y in px
  kSpline = 3,   // x, y of each control point: px
  kPose = 4,     // x, y, z m, rotation vector rad: takes the object's coordinates to the camera's
  kMotion = 5,   // a0 to a1, a5 or a7 of eq. (8), from the last image to this one: see motion/motion_feature_tracker.h
  // h00 h01 h02 h10 h11 h12 h20 h21 of H with h22 = 1: takes px of the image of the selection to px of this one
  kHomography = 6,
};

// "point", "line", ..., as people write it.
const char* kindName(FeatureKind kind);

// A place of a feature at which an edge was searched.
struct TrackedSite {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();  // px
  double weight = 0.0;                              // 0 (no edge, or astray) to 1: how far the fit believed it
};

struct TrackedFeature {
  std::string id;  // within its tracker, as it was selected
  FeatureKind kind = FeatureKind::kPoint;
  State state = State::kIdle;
  std::string reason;  // a sentence without a full stop: why the state is not TRACKING; empty: it is
  // By kind. TRACKING: as seen; SEARCHING, LOST: where it is expected; IDLE: empty.
  Eigen::VectorXd parameters;
  Eigen::MatrixXd covariance;            // of the parameters; unless TRACKING the variances are infinite
  Eigen::VectorXd desired;               // the parameters' values that were wanted with the selection; empty: none
  double share = 0.0;                    // of its sites, or pixels, in the image that agree with it: 0 to 1
  double expected_error = 0.0;           // px, standard deviation at its worst place; infinite unless TRACKING
  std::vector<Eigen::Vector2d> outline;  // px, to be drawn point by point; one point: a centre. Empty: nothing to draw
  double radius = 0.0;                   // m, of a POSE that is a cylinder about its z axis; 0: it is none
  std::vector<TrackedSite> sites;        // of the last image; empty where no edges are searched
};

// All features of a tracker, in the order of their selection.
struct TrackedFeatures {
  // TRACKING: all are; else the worst of theirs: LOST before SEARCHING, IDLE where nothing is selected. The reason is
  // that of the first feature in that state, with its id.
  State state = State::kIdle;
  std::string reason;
  std::vector<TrackedFeature> features;
};

// The covariance of parameters of which nothing is known: infinite variances, and 0 beside them.
template <class Covariance>
void setUnknown(Covariance& covariance) {
  covariance.setZero();
  covariance.diagonal().setConstant(std::numeric_limits<double>::infinity());
}
// Of `count` parameters.
void setUnknown(Eigen::MatrixXd& covariance, Eigen::Index count);

// Of a fit to edges, those in the image that have a say; not those beyond the curve's end.
void tellSites(const std::vector<SiteFinding>& findings, std::vector<TrackedSite>& sites);

// Sets state and reason of all by those of each, or `why_none` when there is no feature.
void summarise(TrackedFeatures& features, std::string_view why_none);

}  // namespace laparoscope_servo::features
