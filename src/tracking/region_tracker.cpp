#include "laparoscope_servo/tracking/region_tracker.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "laparoscope_servo/geometry/sl3.h"
#include "laparoscope_servo/image/field_mask.h"
#include "laparoscope_servo/image/image_type.h"
#include "laparoscope_servo/parameters/table.h"
#include "laparoscope_servo/validation/error_report.h"
#include "tracking/align/quality.h"
#include "tracking/align/region_aligner.h"
#include "tracking/motion_filter.h"
#include "tracking/roi_check.h"
#include "tracking/search/region_search.h"
#include "tracking/selection/proposal.h"

namespace laparoscope_servo::tracking {

namespace {

// px, by how much a corner is searched for around its prediction: so many times what is usual, never less than this.
constexpr double kReach = 4.0;
constexpr double kLeastReach = 12.0;   // lengthUnit()s
constexpr double kSearchReach = 0.25;  // of the ROI's larger side, when it has been lost

// Of min_texture, what noise may do in a region that is proposed. Of 92 regions on eight films the 60 in which it did
// less than this were held for a second in 42 cases, the others in 15 of 32.
constexpr double kClearly = 0.3;

}  // namespace

const char* stateName(State state) {
  switch (state) {
    case State::kIdle:
      return "IDLE";
    case State::kTracking:
      return "TRACKING";
    case State::kSearching:
      return "SEARCHING";
    case State::kLost:
      return "LOST";
  }
  return "unknown";
}

class RegionTracker::Implementation {
 public:
  explicit Implementation(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens = nullptr)
      : config_(config), lens_(lens), aligner_(config, lens), filter_(config.velocity_damping), search_(config, lens) {}

  void setLens(const std::optional<image::Lens>& lens);
  TrackResult select(const cv::Mat& image, double stamp, const geometry::Rectangle& roi, const cv::Mat& mask);
  double check(const cv::Mat& image, const geometry::Rectangle& wanted, RegionAligner& aligner,
               const cv::Mat& mask = cv::Mat()) const;
  std::optional<geometry::Rectangle> propose(const cv::Mat& image, const geometry::Rectangle& wanted) const;
  void recall(const cv::Mat& reference, double reference_stamp, const geometry::Rectangle& roi, double now);
  const TrackResult& track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion,
                           const cv::Mat& mask);
  void reset();
  cv::Mat occlusionMask() const;
  bool hasRoi() const { return state_ != State::kIdle; }
  const std::shared_ptr<const image::Lens>& lens() const { return lens_; }
  const TrackerConfig& config() const { return config_; }
  void retune(const TrackerConfig& config);

 private:
  double setReference(const cv::Mat& image, double stamp, const geometry::Rectangle& wanted,
                      const cv::Mat& mask = cv::Mat());
  std::optional<Eigen::Matrix3d> carriedBy(const std::optional<Eigen::Matrix3d>& motion) const;
  Attempt attempt(const cv::Mat& image, double stamp, const EsmState& start, const MotionPrior* prior,
                  bool confirming = false);
  Attempt search(const cv::Mat& image, double stamp);
  void decide(const Attempt& best, const MotionPrior& prior, double stamp);
  // Of the image, px of the raw one: where the ROI is seen at `g`, with room for what it may move besides.
  cv::Rect seenBox(const Eigen::Matrix3d& g) const;
  const Eigen::Matrix3d& shown() const;
  const TrackResult& report(const Attempt& attempt);
  const TrackResult& idle(double stamp, const std::string& reason);

  TrackerConfig config_;
  std::shared_ptr<const image::Lens> lens_;  // null: none
  std::string reset_reason_;                 // for the next image
  RegionAligner aligner_;
  MotionFilter filter_;
  RegionSearch search_;
  image::FieldMask field_;  // of the last image

  State state_ = State::kIdle;
  cv::Size image_size_;
  double reference_stamp_ = 0.0;
  double last_stamp_ = 0.0;
  double proven_stamp_ = 0.0;               // of the last image in which blocks were where the estimate has them
  double unseen_before_ = 0.0;              // s, from the reference until it was recalled; 0 once it was found
  EsmState last_;                           // last estimate that was believed
  std::optional<Eigen::Matrix3d> carried_;  // the same, moved as a robot says: where the last attempt started from
  TrackRecord record_;
  TrackResult result_;  // of the last image
};

void RegionTracker::Implementation::setLens(const std::optional<image::Lens>& lens) {
  const bool same = lens ? lens_ && *lens_ == *lens : !lens_;
  if (same) return;
  const bool had_roi = hasRoi();
  *this = Implementation(config_, lens ? std::make_shared<const image::Lens>(*lens) : nullptr);
  if (had_roi) reset_reason_ = "the lens changed since the ROI was selected: select it again";
}

// Makes it the reference of an aligner. Returns the expected corner error [px] of the reference with itself.
double RegionTracker::Implementation::check(const cv::Mat& image, const geometry::Rectangle& wanted,
                                            RegionAligner& aligner, const cv::Mat& mask) const {
  checkImage(image);
  image::checkMask(mask, image);
  image::FieldMask field;
  field.look(image);
  const geometry::Rectangle roi = checkedRoi(image, wanted, config_.min_roi_side, lens_.get());
  checkWithinField(roi, field, lens_.get());
  aligner.setMask(field.joined(mask));
  aligner.setReference(image, roi);
  return checkedCornerError(aligner, config_.min_texture);
}

std::optional<geometry::Rectangle> RegionTracker::Implementation::propose(const cv::Mat& image,
                                                                          const geometry::Rectangle& wanted) const {
  checkImage(image);
  if (!(wanted.width >= 1.0 && wanted.height >= 1.0) ||
      !std::isfinite(wanted.x + wanted.y + wanted.width + wanted.height))
    throw std::invalid_argument("the ROI is too small, expected at least 1 px in width and height, and finite numbers");
  geometry::Rectangle least = wanted;
  least.width = std::max<double>(wanted.width, config_.min_roi_side);
  least.height = std::max<double>(wanted.height, config_.min_roi_side);
  RegionAligner aligner(config_, lens_);
  image::FieldMask field;
  field.look(image);
  aligner.setMask(field.joined(cv::Mat()));
  return proposeRegion(image, least, lens_.get(), [&](const geometry::Rectangle& roi) {
    try {
      checkWithinField(roi, field, lens_.get());
      aligner.setReference(image, checkedRoi(image, roi, config_.min_roi_side, lens_.get()));
      return aligner.referenceTexture().corner_error <= kClearly * config_.min_texture;
    } catch (const std::invalid_argument&) {
      return false;
    }
  });
}

double RegionTracker::Implementation::setReference(const cv::Mat& image, double stamp,
                                                   const geometry::Rectangle& wanted, const cv::Mat& mask) {
  // Everything is built aside, so that a ROI that is refused leaves the tracker as it was.
  Implementation fresh(config_, lens_);
  const double error = check(image, wanted, fresh.aligner_, mask);
  fresh.search_.setReference(image, fresh.aligner_);
  fresh.image_size_ = image.size();
  fresh.reference_stamp_ = stamp;
  *this = std::move(fresh);
  return error;
}

TrackResult RegionTracker::Implementation::select(const cv::Mat& image, double stamp, const geometry::Rectangle& wanted,
                                                  const cv::Mat& mask) {
  const double error = setReference(image, stamp, wanted, mask);
  const geometry::Rectangle& roi = aligner_.roi();
  filter_.start(roi, aligner_.esm().normalisation(), stamp);
  state_ = State::kTracking;
  last_stamp_ = proven_stamp_ = stamp;

  Attempt attempt;
  attempt.evidence.roi = roi;
  attempt.evidence.esm.status = EsmStatus::kConverged;
  attempt.evidence.esm.corner_error = attempt.evidence.corner_error = error;
  attempt.evidence.centre_error = error;  // it is not known worse than the worst corner
  const cv::Mat1f weights = aligner_.weights();
  attempt.evidence.visible_fraction = cv::sum(weights)[0] / weights.cols / weights.rows;
  attempt.evidence.zncc = 1.0;
  TrackResult result = report(attempt);
  result.selected_now = true;
  return result;
}

void RegionTracker::Implementation::recall(const cv::Mat& reference, double reference_stamp,
                                           const geometry::Rectangle& wanted, double now) {
  setReference(reference, reference_stamp, wanted);
  filter_.start(aligner_.roi(), aligner_.esm().normalisation(), now);
  filter_.stop();
  state_ = State::kSearching;
  last_stamp_ = proven_stamp_ = now;
  unseen_before_ = std::max(0.0, now - reference_stamp);
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
  if (!std::isfinite(stamp)) throw std::invalid_argument("image stamp is not finite");
  std::ostringstream why;
  if (stamp < last_stamp_) {
    why << "time jumped back by " << last_stamp_ - stamp << " s";
  } else if (image.size() != image_size_) {
    why << "image size changed from " << image_size_.width << " x " << image_size_.height << " to " << image.cols
        << " x " << image.rows << " px: select the ROI again";
  }
  if (!why.str().empty()) {
    reset();
    return idle(stamp, why.str());
  }
  carried_ = carriedBy(motion);
  MotionPrior prior = filter_.predict(stamp, carried_);
  field_.look(image);
  const bool deep = state_ == State::kTracking && field_.contains(seenBox(prior.predicted));
  aligner_.setMask(deep ? mask : field_.joined(mask));
  Attempt best;
  if (state_ == State::kTracking) {
    EsmState start = last_;
    start.g = prior.predicted;
    best = attempt(image, stamp, start, &prior);
    if (carried_ && !best.doubt.empty()) {
      // If the ego-motion prior led to no accepted estimate, retry without it and discard its gate results.
      carried_.reset();
      aligner_.startAfresh();
      prior = filter_.predict(stamp);
      start.g = prior.predicted;
      best = attempt(image, stamp, start, &prior);
    }
  } else {
    best = search(image, stamp);
  }
  decide(best, prior, stamp);
  if (state_ == State::kTracking) search_.keepKeyframe(image, stamp, best.evidence, last_.g, aligner_);
  aligner_.advance();
  last_stamp_ = stamp;
  return report(best);
}

cv::Rect RegionTracker::Implementation::seenBox(const Eigen::Matrix3d& g) const {
  const geometry::Rectangle& roi = aligner_.roi();
  return image::seenBox(lens_.get(), geometry::apply(g, roi.corners()), kLeastReach * lengthUnit(roi));
}

// The last G moved by the ego-motion; empty if the result is implausible.
std::optional<Eigen::Matrix3d> RegionTracker::Implementation::carriedBy(
    const std::optional<Eigen::Matrix3d>& motion) const {
  if (!motion || !motion->allFinite() || !(motion->determinant() > 1e-12)) return std::nullopt;
  const Eigen::Matrix3d g = geometry::normaliseDeterminant(*motion * last_.g);
  const geometry::Quadrilateral corners = geometry::apply(g, aligner_.roi().corners());
  const double ratio = geometry::signedArea(corners) / geometry::signedArea(aligner_.roi().corners());
  const bool possible = geometry::isConvex(corners) && std::max(ratio, 1.0 / ratio) <= config_.quality.max_area_ratio;
  return possible ? std::optional<Eigen::Matrix3d>(g) : std::nullopt;
}

// With a prior when the ROI was tracked until the image before; without when it is searched for.
Attempt RegionTracker::Implementation::attempt(const cv::Mat& image, double stamp, const EsmState& start,
                                               const MotionPrior* prior, bool confirming) {
  const geometry::Rectangle& roi = aligner_.roi();
  const double reach = prior != nullptr ? std::max(kLeastReach * lengthUnit(roi), kReach * record_.innovation())
                                        : std::max(32.0, kSearchReach * std::max(roi.width, roi.height));
  const Alignment found = aligner_.align(image, start, prior, reach);
  Attempt result;
  Evidence& e = result.evidence;
  e.roi = roi;
  e.predicted = start.g;
  e.from_track = prior != nullptr;
  e.confirming = confirming;
  e.last_gain = last_.gain;
  e.light_gain = aligner_.gates().lightGain();
  e.unseen = unseen_before_ + stamp - filter_.lastStamp();
  e.record = record_;
  e.esm = found.esm;
  e.visible_fraction = found.visible_fraction;
  e.in_image = found.share_in_image;
  e.zncc = found.zncc;
  e.blocks = found.blocks;
  e.corner_error = found.corner_error;
  e.centre_error = found.centre_error;
  e.unproven = stamp - proven_stamp_;
  result.doubt = found.in_image ? doubt(e, config_.quality) : "the ROI is outside the image";
  return result;
}

Attempt RegionTracker::Implementation::search(const cv::Mat& image, double stamp) {
  search_.begin(last_, carried_);
  while (const std::optional<SearchPlace> place = search_.next(image, aligner_)) {
    aligner_.startAfresh();
    const bool confirming = place->by == Suggestion::kConfirmation;
    if (search_.judge(attempt(image, stamp, place->start, nullptr, confirming), aligner_)) break;
  }
  if (search_.suggestedBy() != Suggestion::kCarried) carried_.reset();
  return search_.best();
}

void RegionTracker::Implementation::decide(const Attempt& best, const MotionPrior& prior, double stamp) {
  const QualityConfig& quality = config_.quality;
  const Evidence& e = best.evidence;
  if (!best.doubt.empty()) {
    search_.confirmation().forget();
    filter_.stop();
    if (state_ == State::kTracking) {
      state_ = State::kSearching;
      search_.restart();
    }
    if (stamp - filter_.lastStamp() > quality.max_search_time) state_ = State::kLost;
    return;
  }
  if (state_ != State::kTracking) {
    if (!search_.confirmation().add(e.esm, aligner_.roi(), record_)) return;
    state_ = State::kTracking;
    filter_.restart(e.esm, stamp);
  } else {
    record_.add(e.zncc, e.esm.sigma, geometry::cornerDistance(e.predicted, e.esm.state.g, aligner_.roi()),
                e.visible_fraction, stamp - filter_.lastStamp());
    filter_.update(prior, e.esm, stamp, e.visible_fraction >= kRecordVisible, carried_);
  }
  search_.confirmation().forget();
  if (e.blocks.confident >= leastBlocks(e.blocks, e.visible_fraction)) proven_stamp_ = stamp;
  unseen_before_ = 0.0;
  last_ = e.esm.state;
}

// The G to report: while searching, the candidate that is not confirmed yet.
const Eigen::Matrix3d& RegionTracker::Implementation::shown() const {
  const Confirmation& found = search_.confirmation();
  return state_ != State::kTracking && found.waiting() ? found.candidate().g : last_.g;
}

// Keeps the memory of the result before.
const TrackResult& RegionTracker::Implementation::report(const Attempt& attempt) {
  TrackResult& result = result_;
  result.reason = attempt.doubt;
  result.state = state_;
  if (state_ != State::kTracking && attempt.doubt.empty()) result.reason = "found, waits for confirmation";
  result.g = shown();
  result.roi = aligner_.roi();
  result.reference_stamp = reference_stamp_;
  result.visible_fraction = attempt.evidence.visible_fraction;
  result.zncc = attempt.evidence.zncc;
  result.iterations = attempt.evidence.esm.iterations;
  result.corner_error = attempt.evidence.corner_error;
  result.centre_error = attempt.evidence.centre_error;
  result.corner_scatter = attempt.evidence.esm.corner_error;
  result.sigma = attempt.evidence.esm.sigma;
  result.motion_used = carried_ && attempt.doubt.empty();
  result.gain = attempt.evidence.esm.state.gain;
  result.bias = attempt.evidence.esm.state.bias;
  const OcclusionGates& gates = aligner_.gates();
  result.colour_used = gates.colourUsed();
  const image::AreaGrid& grid = gates.grid();
  result.areas.rows = grid.rows();
  result.areas.columns = grid.columns();
  result.areas.distance = gates.distances();
  result.areas.occluded.resize(grid.count());
  for (int area = 0; area < grid.count(); ++area) result.areas.occluded[area] = gates.covered(area);
  gates.causes(result.areas.cause);
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
  aligner_.retune(config_);
  filter_.setDamping(config_.velocity_damping);
  search_.retune(config_);
}

void RegionTracker::Implementation::reset() {
  *this = Implementation(config_, lens_);
}

cv::Mat RegionTracker::Implementation::occlusionMask() const {
  return state_ == State::kIdle ? cv::Mat() : aligner_.occlusionMask(shown(), image_size_);
}

RegionTracker::RegionTracker(const TrackerConfig& config) {
  validation::throwErrors("tracker", validate(config));
  implementation_ = std::make_unique<Implementation>(config);
}

RegionTracker::~RegionTracker() = default;
RegionTracker::RegionTracker(RegionTracker&&) noexcept = default;
RegionTracker& RegionTracker::operator=(RegionTracker&&) noexcept = default;

void RegionTracker::retune(const TrackerConfig& config) {
  validation::throwErrors("tracker", validate(config));
  implementation_->retune(config);
}
void RegionTracker::setLens(const std::optional<image::Lens>& lens) {
  implementation_->setLens(lens);
}

TrackResult RegionTracker::select(const cv::Mat& image, double stamp, const geometry::Rectangle& roi,
                                  const cv::Mat& external_mask) {
  return implementation_->select(image, stamp, roi, external_mask);
}
void RegionTracker::check(const cv::Mat& image, const geometry::Rectangle& roi) const {
  RegionAligner aligner(config(), implementation_->lens());
  implementation_->check(image, roi, aligner);
}
std::optional<geometry::Rectangle> RegionTracker::propose(const cv::Mat& image, const geometry::Rectangle& roi) const {
  return implementation_->propose(image, roi);
}
void RegionTracker::recall(const cv::Mat& reference, double reference_stamp, const geometry::Rectangle& roi,
                           double now) {
  implementation_->recall(reference, reference_stamp, roi, now);
}
const TrackResult& RegionTracker::track(const cv::Mat& image, double stamp,
                                        const std::optional<Eigen::Matrix3d>& motion, const cv::Mat& external_mask) {
  return implementation_->track(image, stamp, motion, external_mask);
}
void RegionTracker::reset() {
  implementation_->reset();
}
cv::Mat RegionTracker::occlusionMask() const {
  return implementation_->occlusionMask();
}
bool RegionTracker::hasRoi() const {
  return implementation_->hasRoi();
}
const TrackerConfig& RegionTracker::config() const {
  return implementation_->config();
}

}  // namespace laparoscope_servo::tracking
