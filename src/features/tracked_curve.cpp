#include "features/tracked_curve.h"

#include <stdexcept>
#include <string>

#include "laparoscope_servo/features/curve_tracker.h"
#include "laparoscope_servo/features/ellipse.h"
#include "laparoscope_servo/features/line.h"
#include "laparoscope_servo/features/spline.h"

namespace laparoscope_servo::features {

namespace {

constexpr int kOutlinePieces = 48;
constexpr int kSplineSteps = 4;  // of the outline, from knot to knot

void curveOf(const SelectedFeature& selected, Line& line) {
  line = Line(selected.points[0], selected.points[1]);
}

void curveOf(const SelectedFeature& selected, Ellipse& ellipse) {
  if (selected.ellipse) {
    const EllipseSelection& e = *selected.ellipse;
    ellipse = Ellipse(e.centre, e.a, e.b, e.angle);
  } else {
    ellipse = Ellipse::throughPoints(selected.points);
  }
  if (selected.arc) ellipse.setArc(selected.arc->begin, selected.arc->extent);
}

void curveOf(const SelectedFeature& selected, Spline& spline) {
  spline = Spline::throughPoints(selected.points, selected.closed);
}

// `covariance`: of the curve's own parameters.
void tellCurve(const Line& line, const Eigen::MatrixXd& covariance, TrackedFeature& told) {
  told.parameters = Eigen::Vector2d(line.rho(), line.theta());
  if (told.state == State::kTracking) told.covariance = line.covariance(covariance);
  told.outline.resize(2);
  told.outline[0] = line.begin();
  told.outline[1] = line.end();
}

void tellCurve(const Ellipse& ellipse, const Eigen::MatrixXd& covariance, TrackedFeature& told) {
  told.parameters = ellipse.coefficients();
  if (told.state == State::kTracking) told.covariance = ellipse.covariance(covariance);
  told.outline.resize(kOutlinePieces + 1);
  for (int k = 0; k <= kOutlinePieces; ++k)
    told.outline[static_cast<std::size_t>(k)] =
        ellipse.at(ellipse.arcBegin() + k * ellipse.arcExtent() / kOutlinePieces);
}

void tellCurve(const Spline& spline, const Eigen::MatrixXd& covariance, TrackedFeature& told) {
  told.parameters.resize(2 * spline.size());
  for (int k = 0; k < spline.size(); ++k) told.parameters.segment<2>(2 * k) = spline.controlPoint(k);
  if (told.state == State::kTracking) spline.spread(covariance, told.covariance);
  const int steps = kSplineSteps * spline.pieces();
  told.outline.resize(static_cast<std::size_t>(steps + 1));
  for (int k = 0; k <= steps; ++k) {
    told.outline[static_cast<std::size_t>(k)] = spline.at(static_cast<double>(k) / kSplineSteps);
  }
}

template <class C>
class TrackedCurveOf : public TrackedCurve {
 public:
  explicit TrackedCurveOf(const EdgeConfig& config) : tracker_(config) {}

  void select(const cv::Mat& image, double stamp, const SelectedFeature& selected) override {
    C curve;
    curveOf(selected, curve);
    tracker_.select(image, stamp, curve, selected.range);
  }

  void track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion) override {
    tracker_.track(image, stamp, motion);
  }

  void tell(TrackedFeature& told) const override {
    const CurveResult<C>& result = tracker_.result();
    told.state = result.state;
    told.reason = reasonText(result.reason);
    told.share = result.share;
    told.expected_error = result.expected_error;
    tellCurve(result.curve, tracker_.covariance(), told);
    if (told.state != State::kTracking) setUnknown(told.covariance, told.parameters.size());
    tellSites(tracker_.findings(), told.sites);
  }

 private:
  CurveTracker<C> tracker_;
};

}  // namespace

std::unique_ptr<TrackedCurve> makeTrackedCurve(FeatureKind kind, const EdgeConfig& config) {
  if (kind == FeatureKind::kLine) return std::make_unique<TrackedCurveOf<Line>>(config);
  if (kind == FeatureKind::kEllipse) return std::make_unique<TrackedCurveOf<Ellipse>>(config);
  if (kind == FeatureKind::kSpline) return std::make_unique<TrackedCurveOf<Spline>>(config);
  throw std::invalid_argument(std::string("a ") + kindName(kind) + " is no curve, expected line, ellipse or spline");
}

}  // namespace laparoscope_servo::features
