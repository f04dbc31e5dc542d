#include "laparoscope_servo/tracking/quality.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace laparoscope_servo::tracking {

namespace {

// px: an alignment that still moves by less than this after all its iterations is as good as converged.
constexpr double kNearlyConverged = 1.0;

std::string text(const char* what, double value, const char* limit, double bound) {
  std::ostringstream stream;
  stream.precision(3);
  stream << what << ' ' << value << ", expected " << limit << ' ' << bound;
  return stream.str();
}

}  // namespace

std::string doubt(const Evidence& e, const QualityConfig& q) {
  if (e.esm.status == EsmStatus::kOutOfView) return "the ROI's image crosses infinity";
  if (e.esm.status == EsmStatus::kIllConditioned) return "the pixels kept do not determine the motion";
  if (!(e.visible_fraction >= q.min_visible_fraction)) {
    return text("visible fraction", e.visible_fraction, "at least", q.min_visible_fraction);
  }
  if (e.esm.status == EsmStatus::kMaxIterations && !(e.esm.last_step <= kNearlyConverged)) {
    return text("still moving by [px]", e.esm.last_step, "at most", kNearlyConverged);
  }
  const geometry::Quadrilateral corners = geometry::apply(e.esm.state.g, e.roi.corners());
  if (!geometry::isConvex(corners)) return "the ROI's image is not convex";
  const double ratio = geometry::signedArea(corners) / geometry::signedArea(e.roi.corners());
  if (!(std::max(ratio, 1.0 / ratio) <= q.max_area_ratio)) {
    return text("area ratio", ratio, "within a factor of", q.max_area_ratio);
  }
  if (!(e.zncc >= q.min_zncc)) return text("correlation", e.zncc, "at least", q.min_zncc);
  if (!(e.esm.corner_error <= q.max_corner_error)) {
    return text("expected corner error [px]", e.esm.corner_error, "at most", q.max_corner_error);
  }
  if (e.predicted_from_track) {
    const geometry::Quadrilateral predicted = geometry::apply(e.predicted, e.roi.corners());
    double jump = 0.0;
    for (int k = 0; k < 4; ++k) jump = std::max(jump, (corners[k] - predicted[k]).norm());
    jump /= std::hypot(e.roi.width, e.roi.height);
    if (!(jump <= q.max_jump)) return text("jump [ROI diagonals]", jump, "at most", q.max_jump);
  }
  return "";
}

}  // namespace laparoscope_servo::tracking
