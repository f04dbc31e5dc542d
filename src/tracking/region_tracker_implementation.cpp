#include "tracking/region_tracker_implementation.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "laparoscope_servo/geometry/sl3.h"
#include "laparoscope_servo/image/image_type.h"
#include "laparoscope_servo/parameters/table.h"
#include "tracking/align/quality.h"
#include "tracking/roi_check.h"

namespace laparoscope_servo::tracking {

namespace {

// px, by how much a corner is searched for around its prediction: so many times what is usual, never less than this.
constexpr double kReach = 4.0;
constexpr double kLeastReach = 12.0;   // lengthUnit()s
constexpr double kSearchReach = 0.25;  // of the ROI's larger side, when it has been lost

void checkStamp(double stamp) {
  if (!std::isfinite(stamp)) throw std::invalid_argument("image stamp is not finite");
}

}  // namespace

void RegionTracker::Implementation::setLens(const std::optional<image::Lens>& lens) {
  const bool same = lens ? lens_ && *lens_ == *lens : !lens_;
  if (same) return;
  const bool had_roi = hasRoi();
  *this = Implementation(config_, lens ? std::make_shared<const image::Lens>(*lens) : nullptr);
  if (had_roi) reset_reason_ = "the lens changed since the ROI was selected: select it again";
}

double RegionTracker::Implementation::setReference(const cv::Mat& image, double stamp,
                                                   const geometry::Rectangle& wanted, const cv::Mat& mask) {
  checkStamp(stamp);
  // Everything is built aside, so that a ROI that is refused leaves the tracker as it was.
  Implementation fresh(config_, lens_);
  const double error = takeReference(image, wanted, mask, config_, lens_.get(), fresh.aligners_.usual());
  fresh.aligners_.setBright(image);
  fresh.search_.setReference(image, fresh.aligners_.usual());
  fresh.image_size_ = image.size();
  fresh.reference_stamp_ = stamp;
  *this = std::move(fresh);
  return error;
}

TrackResult RegionTracker::Implementation::select(const cv::Mat& image, double stamp, const geometry::Rectangle& wanted,
                                                  const cv::Mat& mask) {
  const double error = setReference(image, stamp, wanted, mask);
  const geometry::Rectangle& roi = aligners_.usual().roi();
  history_.start(roi, aligners_.usual().esm().normalisation(), stamp);
  state_ = State::kTracking;
  last_stamp_ = stamp;

  Attempt attempt;
  attempt.evidence.roi = roi;
  attempt.evidence.esm.status = EsmStatus::kConverged;
  attempt.evidence.esm.corner_error = attempt.evidence.corner_error = error;
  attempt.evidence.centre_error = error;  // it is not known worse than the worst corner
  const cv::Mat1f weights = aligners_.now().weights();
  attempt.evidence.visible_fraction = cv::sum(weights)[0] / weights.cols / weights.rows;
  attempt.evidence.zncc = 1.0;
  TrackResult result = report(attempt);
  result.selected_now = true;
  return result;
}

void RegionTracker::Implementation::recall(const cv::Mat& reference, double reference_stamp,
                                           const geometry::Rectangle& wanted, double now) {
  checkStamp(now);
  setReference(reference, reference_stamp, wanted);
  history_.startUnseen(aligners_.usual().roi(), aligners_.usual().esm().normalisation(), reference_stamp, now);
  state_ = State::kSearching;
  last_stamp_ = now;
  search_.restart();
}

const TrackResult& RegionTracker::Implementation::track(const cv::Mat& image, double stamp,
                                                        const std::optional<Eigen::Matrix3d>& motion,
                                                        const cv::Mat& mask) {
  checkImage(image);
  image::checkMask(mask, image);
  if (state_ == State::kIdle) {
    const TrackResult& result = idle(stamp, reset_reason_.empty() ? "no region of interest selected" : reset_reason_);
    reset_reason_.clear();
    return result;
  }
  checkStamp(stamp);
  const std::string why = whyAnotherSequence(image, stamp);
  if (!why.empty()) {
    reset();
    return idle(stamp, why);
  }
  carried_ = carriedBy(motion);
  MotionPrior prior = history_.predict(stamp, carried_);
  field_.look(image);
  const bool deep = state_ == State::kTracking && field_.contains(seenBox(prior.predicted));
  aligners_.setMask(deep ? mask : field_.joined(mask));
  const Attempt best = state_ == State::kTracking ? follow(image, stamp, prior) : search(image, stamp);
  decide(best, prior, stamp);
  if (state_ == State::kTracking) {
    aligners_.remember(history_.last());
    search_.keepKeyframe(image, stamp, best.evidence, history_.last().g, aligners_.now());
  }
  aligners_.advance();
  last_stamp_ = stamp;
  return report(best);
}

std::string RegionTracker::Implementation::whyAnotherSequence(const cv::Mat& image, double stamp) const {
  std::ostringstream why;
  if (stamp < last_stamp_) {
    why << "time jumped back by " << last_stamp_ - stamp << " s";
  } else if (image.size() != image_size_) {
    why << "image size changed from " << image_size_.width << " x " << image_size_.height << " to " << image.cols
        << " x " << image.rows << " px: select the ROI again";
  }
  return why.str();
}

cv::Rect RegionTracker::Implementation::seenBox(const Eigen::Matrix3d& g) const {
  const geometry::Rectangle& roi = aligners_.usual().roi();
  return image::seenBox(lens_.get(), geometry::apply(g, roi.corners()), kLeastReach * lengthUnit(roi));
}

// The last G moved by the ego-motion; empty if the result is implausible.
std::optional<Eigen::Matrix3d> RegionTracker::Implementation::carriedBy(
    const std::optional<Eigen::Matrix3d>& motion) const {
  if (!motion || !motion->allFinite() || !(motion->determinant() > 1e-12)) return std::nullopt;
  const Eigen::Matrix3d g = geometry::normaliseDeterminant(*motion * history_.last().g);
  const geometry::Quadrilateral corners = geometry::apply(g, aligners_.usual().roi().corners());
  const double ratio = geometry::signedArea(corners) / geometry::signedArea(aligners_.usual().roi().corners());
  const bool possible = geometry::isConvex(corners) && std::max(ratio, 1.0 / ratio) <= config_.quality.max_area_ratio;
  return possible ? std::optional<Eigen::Matrix3d>(g) : std::nullopt;
}

// One attempt from the prediction; if it is not accepted, another one with the colours that are left in bright light.
// If the prediction was that of an ego-motion and no estimate was accepted, retries without the ego-motion, discards
// the results of its gates, and leaves the prior that was used.
Attempt RegionTracker::Implementation::follow(const cv::Mat& image, double stamp, MotionPrior& prior) {
  EsmState start = history_.last();
  start.g = prior.predicted;
  Attempt first = attempt(image, stamp, start, &prior);
  if (!first.doubt.empty() && aligners_.turnBright(image, start.g)) first = attempt(image, stamp, start, &prior);
  if (!carried_ || first.doubt.empty()) return first;
  carried_.reset();
  aligners_.startAfresh();
  prior = history_.predict(stamp, carried_);
  start.g = prior.predicted;
  return attempt(image, stamp, start, &prior);
}

// With a prior when the ROI was tracked until the image before; without, but at a place, when it is searched for.
Attempt RegionTracker::Implementation::attempt(const cv::Mat& image, double stamp, const EsmState& start,
                                               const MotionPrior* prior, const SearchPlace* searched) {
  const geometry::Rectangle& roi = aligners_.usual().roi();
  const double reach = prior != nullptr
                           ? std::max(kLeastReach * lengthUnit(roi), kReach * history_.record().innovation())
                           : std::max(32.0, kSearchReach * std::max(roi.width, roi.height));
  if (prior == nullptr) aligners_.turnBright(image, start.g);
  const EsmState lit = aligners_.choose(image, start);
  const AlignmentLimits limits = searched != nullptr ? searched->limits : AlignmentLimits();
  const Alignment found = aligners_.now().align(image, lit, prior, reach, limits);
  Attempt result;
  Evidence& e = result.evidence;
  e.roi = roi;
  e.predicted = start.g;
  e.from_track = prior != nullptr;
  e.confirming = searched != nullptr && searched->by == Suggestion::kConfirmation && confirmation_.justFound();
  e.light_gain = aligners_.now().gates().lightGain();
  e.esm = found.esm;
  e.visible_fraction = found.visible_fraction;
  e.in_image = found.share_in_image;
  e.zncc = found.zncc;
  e.blocks = found.blocks;
  e.corner_error = found.corner_error;
  e.centre_error = found.centre_error;
  history_.compare(stamp, e);
  result.doubt = found.in_image ? doubt(e, config_.quality) : "the ROI is outside the image";
  return result;
}

Attempt RegionTracker::Implementation::search(const cv::Mat& image, double stamp) {
  search_.begin(history_.last(), carried_, confirmation_.awaited());
  while (const std::optional<SearchPlace> place = search_.next(image, aligners_.usual())) {
    aligners_.startAfresh();
    if (search_.judge(attempt(image, stamp, place->start, nullptr, &*place), aligners_.now())) break;
  }
  if (search_.suggestedBy() != Suggestion::kCarried) carried_.reset();
  return search_.best();
}

void RegionTracker::Implementation::decide(const Attempt& best, const MotionPrior& prior, double stamp) {
  if (!best.doubt.empty()) {
    confirmation_.miss(stamp);
    history_.addMiss();
    if (state_ == State::kTracking) {
      state_ = State::kSearching;
      search_.restart();
    }
    if (history_.sinceLast(stamp) > config_.quality.max_search_time) state_ = State::kLost;
    return;
  }
  if (state_ == State::kTracking) {
    history_.addTracked(best.evidence, prior, stamp, carried_);
  } else {
    if (!confirmation_.add(best.evidence, stamp)) return;
    state_ = State::kTracking;
    history_.addFoundAgain(best.evidence, stamp);
  }
  confirmation_.forget();
}

// The G to report: while searching, the candidate that is not confirmed yet.
const Eigen::Matrix3d& RegionTracker::Implementation::shown() const {
  return state_ != State::kTracking && confirmation_.waiting() ? confirmation_.candidate().g : history_.last().g;
}

// Keeps the memory of the result before.
const TrackResult& RegionTracker::Implementation::report(const Attempt& attempt) {
  const Evidence& e = attempt.evidence;
  TrackResult& result = result_;
  result.state = state_;
  result.reason = attempt.doubt;
  if (state_ != State::kTracking && attempt.doubt.empty()) result.reason = "found, waits for confirmation";
  result.g = shown();
  result.roi = aligners_.usual().roi();
  result.reference_stamp = reference_stamp_;
  result.visible_fraction = e.visible_fraction;
  result.zncc = e.zncc;
  result.iterations = e.esm.iterations;
  result.corner_error = e.corner_error;
  result.centre_error = e.centre_error;
  result.corner_scatter = e.esm.corner_error;
  result.sigma = e.esm.sigma;
  result.gain = e.esm.state.gain;
  result.bias = e.esm.state.bias;
  result.motion_used = carried_ && attempt.doubt.empty();
  result.colour_used = aligners_.now().gates().colourUsed();
  aligners_.now().gates().report(result.areas);
  return result;
}

const TrackResult& RegionTracker::Implementation::idle(double stamp, const std::string& reason) {
  result_ = TrackResult();
  result_.reason = reason;
  result_.reference_stamp = stamp;
  return result_;
}

void RegionTracker::Implementation::retune(const TrackerConfig& config) {
  parameters::copyWhatMayChange(config, config_);
  aligners_.retune(config_);
  history_.setDamping(config_.velocity_damping);
  search_.retune(config_);
  confirmation_.retune(config_.quality);
}

void RegionTracker::Implementation::reset() {
  *this = Implementation(config_, lens_);
}

cv::Mat RegionTracker::Implementation::occlusionMask() const {
  return state_ == State::kIdle ? cv::Mat() : aligners_.now().occlusionMask(shown(), image_size_);
}

}  // namespace laparoscope_servo::tracking
