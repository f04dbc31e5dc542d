#include "tracking/align/quality.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace laparoscope_servo::tracking {

namespace {

// All px of this file are lengthUnit()s of the image. px: an alignment whose last iteration moved it by less than this
// counts as converged.
constexpr double kNearlyConverged = 1.0;

// Least visible share of the part of the ROI that is in the image. Below it, the remaining areas may be just those that
// happen to agree with a wrong estimate.
constexpr double kMinOfImage = 0.15;

constexpr double kRecordTime = 0.8;  // s, time constant of the record

// How much worse than the record an estimate may be: factor and constant on the unexplained share 1 - zncc, and on
// sigma [grey levels]. Less is allowed to a search, which starts anywhere and keeps the areas that agree; its false
// fits have 1.5 to 4 times the residual.
struct Tolerance {
  double unexplained_factor, unexplained, sigma_factor, sigma;
};
constexpr Tolerance kTracking = {2.0, 0.10, 2.0, 1.0};
constexpr Tolerance kSearching = {1.5, 0.05, 1.5, 0.3};

// Factor by which the gain may differ between the last accepted estimate and one that a search has found:
// kMaxGainChange at once, and more for each second since.
constexpr double kMaxGainChange = 1.5;
constexpr double kGainChangeRate = 0.5;  // 1/s

// Block matching. If kEnoughBlocks blocks, and this share of those in the image, are where the estimate puts them, it
// is the ROI, whatever the illumination and the noise; in images of other scenes fewer than three blocks moved alike.
constexpr int kEnoughBlocks = 6;
constexpr double kRecognised = 0.3;
constexpr double kNear = 3.0;  // px, limit of the median distance of the blocks
// If the blocks that recognise it are spread less than blocks all over a third of it would be, its corners are
// extrapolated by twice what is seen or more: then the corner error counts, with a limit from which on it is wrong.
constexpr double kSpread = 1.0 / 3.0;
constexpr double kWrong = 5.0;      // px
constexpr int kVisibleTelling = 6;  // kTellingBlocks for blocks that are not covered
constexpr int kFewBlocks = 3;       // blocks that moved alike: the least number for any of them to be confident
// Share of the blocks that can be visible. On chol_blood.mp4 (of the four films where it was looked at) a sixth of 36
// overlapping blocks agreed by chance for 20 images.
constexpr double kFoundOfVisible = 0.25;

// While tracking, block matching is required only if most of the ROI is visible, since blocks beside an instrument are
// covered in part. But if the gates reject all textured areas, the estimate may be wrong: if at least kPartlyVisible is
// visible, block matching is also required once no leastBlocks() blocks were found for kUnproven. If kAsVisible of what
// was visible when they were last found still is, it is not that blocks are covered: then for kUnprovenInSight, which
// bears a blurred image.
constexpr double kMostlyVisible = 0.5;
constexpr double kPartlyVisible = 0.25;
constexpr double kUnproven = 0.2;  // s
constexpr double kAsVisible = 0.8;
constexpr double kUnprovenInSight = 0.1;  // s

// A record can be better than any later correct estimate: values at least this good always pass.
constexpr double kGoodZncc = 0.9;
constexpr double kGoodSigma = 4.0;  // grey levels; typical of a compressed feed
// Tissue changes while it is not seen: over this time, the tolerance grows to its largest value.
constexpr double kForgetting = 2.0;                      // s
constexpr Tolerance kForgotten = {0.0, 0.15, 0.0, 3.0};  // added to the tolerance after kForgetting

std::string text(const char* what, double value, const char* limit, double bound) {
  std::ostringstream stream;
  stream.precision(3);
  stream << what << ' ' << value << ", expected " << limit << ' ' << bound;
  return stream.str();
}

}  // namespace

void TrackRecord::add(double zncc, double sigma, double innovation, double visible_fraction, double dt) {
  ++count_;
  const double rate = std::clamp(dt / kRecordTime, 1.0 / count_, 1.0);
  innovation_ += rate * (innovation - innovation_);
  if (!(visible_fraction >= kRecordVisible)) return;
  zncc_ += rate * (zncc - zncc_);
  sigma_ += rate * (sigma - sigma_);
}

double allowedJump(const TrackRecord& record, const QualityConfig& config, const geometry::Rectangle& roi,
                   double visible_fraction, double corner_error) {
  const double expected = 3.0 * lengthUnit(roi) + 4.0 * record.innovation() + 3.0 * corner_error;
  const double trust = std::clamp((visible_fraction - 0.25) / 0.25, 0.0, 1.0);
  return std::max(expected, trust * config.max_jump * std::hypot(roi.width, roi.height));
}

double leastBlocks(const BlockEvidence& blocks, double visible_fraction) {
  if (blocks.seen < kTellingBlocks) return 0.0;
  return std::max<double>(kFewBlocks,
                          kFoundOfVisible * std::max<double>(blocks.visible, visible_fraction * blocks.seen));
}

bool recognised(const Evidence& e) {
  return e.blocks.confident >= std::max<double>(kEnoughBlocks, kRecognised * e.blocks.seen) &&
         e.blocks.off <= kNear * lengthUnit(e.roi);
}

std::string doubt(const Evidence& e, const QualityConfig& q) {
  if (e.esm.status == EsmStatus::kOutOfView) return "the ROI's image crosses infinity";
  if (e.esm.status == EsmStatus::kIllConditioned) return "the pixels kept do not determine the motion";
  if (e.esm.status == EsmStatus::kInterrupted) return "not aligned within the time of an image";
  const double unit = lengthUnit(e.roi);
  const BlockEvidence& blocks = e.blocks;
  const bool known = recognised(e);
  const double min_visible = e.from_track || e.confirming ? q.min_visible_fraction : q.min_return_fraction;
  if (!(e.visible_fraction >= min_visible))
    return text("visible fraction", e.visible_fraction, "at least", min_visible);
  const double of_image = e.visible_fraction / std::max(e.in_image, 1e-9);
  if (!(of_image >= kMinOfImage))
    return text("visible fraction of what is in the image", of_image, "at least", kMinOfImage);
  if (e.esm.status == EsmStatus::kMaxIterations && !(e.esm.last_step <= kNearlyConverged * unit)) {
    return text("still moving by [px]", e.esm.last_step, "at most", kNearlyConverged * unit);
  }
  const geometry::Quadrilateral corners = geometry::apply(e.esm.state.g, e.roi.corners());
  if (!geometry::isConvex(corners)) return "the ROI's image is not convex";
  const double ratio = geometry::signedArea(corners) / geometry::signedArea(e.roi.corners());
  if (!(std::max(ratio, 1.0 / ratio) <= q.max_area_ratio)) {
    return text("area ratio", ratio, "within a factor of", q.max_area_ratio);
  }
  if (blocks.confident >= kFewBlocks && !(blocks.off <= kMostOff * unit))
    return text("pieces of the region off by [px]", blocks.off, "at most", kMostOff * unit);
  const double patience = e.visible_fraction < kAsVisible * e.proven_visible ? kUnproven : kUnprovenInSight;
  const bool asked = !e.from_track || e.visible_fraction >= kMostlyVisible || blocks.visible >= kVisibleTelling ||
                     (e.visible_fraction >= kPartlyVisible && e.unproven > patience);
  const double least = leastBlocks(blocks, e.visible_fraction);
  if (asked && !(blocks.confident >= least))
    return text("pieces of the region found", blocks.confident, "at least", least);
  Tolerance tolerance = e.from_track ? kTracking : kSearching;
  const double forgotten = e.from_track ? 0.0 : std::clamp(e.unseen / kForgetting, 0.0, 1.0);
  tolerance.unexplained += forgotten * kForgotten.unexplained;
  tolerance.sigma += forgotten * kForgotten.sigma;
  const double min_zncc = std::max(
      q.min_zncc,
      std::min(kGoodZncc, 1.0 - tolerance.unexplained - tolerance.unexplained_factor * (1.0 - e.record.zncc())));
  if (!known && !(e.zncc >= min_zncc)) return text("correlation", e.zncc, "at least", min_zncc);
  const double max_sigma = std::max(kGoodSigma, tolerance.sigma + tolerance.sigma_factor * e.record.sigma());
  if (!known && !(e.esm.sigma <= max_sigma)) return text("residual [grey levels]", e.esm.sigma, "at most", max_sigma);
  const double max_corner_error = known ? std::max(q.max_corner_error, kWrong * unit) : q.max_corner_error;
  const bool determined = known && blocks.spread >= kSpread;
  if (!determined && !(e.esm.corner_error <= max_corner_error)) {
    return text("expected corner error [px]", e.esm.corner_error, "at most", max_corner_error);
  }
  if (!(e.esm.centre_error <= q.max_centre_error)) {
    return text("expected error of the centre [px]", e.esm.centre_error, "at most", q.max_centre_error);
  }
  if (!e.from_track && !known) {
    const auto factor = [&](double gain) { return std::max(gain / e.esm.state.gain, e.esm.state.gain / gain); };
    const double of_last = factor(e.last_gain);
    const double change = e.light_gain > 0.0 ? std::min(of_last, factor(e.light_gain)) : of_last;
    const double allowed = kMaxGainChange + kGainChangeRate * std::max(0.0, e.unseen);
    if (!(change <= allowed)) return text("change of gain", change, "within a factor of", allowed);
  }
  const geometry::Quadrilateral predicted = geometry::apply(e.predicted, e.roi.corners());
  const double jump = geometry::largestDistance(corners, predicted);
  const double max_jump = allowedJump(e.record, q, e.roi, e.visible_fraction, e.esm.corner_error);
  if (!(jump <= max_jump)) return text("jump [px]", jump, "at most", max_jump);
  return "";
}

}  // namespace laparoscope_servo::tracking
