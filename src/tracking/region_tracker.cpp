#include "laparoscope_servo/tracking/region_tracker.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <stdexcept>

#include "laparoscope_servo/geometry/sl3.h"
#include "laparoscope_servo/image/warp.h"
#include "laparoscope_servo/geometry/sl3.h"
#include "laparoscope_servo/tracking/feature_search.h"
#include "laparoscope_servo/tracking/keyframes.h"
#include "laparoscope_servo/tracking/motion_filter.h"
#include "laparoscope_servo/tracking/quality.h"
#include "laparoscope_servo/tracking/region_aligner.h"
#include "laparoscope_servo/tracking/relocalisation.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr double kTypicalNoise = 2.0;    // grey levels, of a laparoscope's camera
constexpr int kSearchCandidates = 2;  // that are aligned, of each stage of the search
// A view is worth storing that was seen nearly whole, and clearly.
constexpr double kKeyframeVisible = 0.7;
constexpr double kKeyframeZncc = 0.85;
// px, by how much a corner is searched for around its prediction: so many times what is usual, and never less than this.
constexpr double kReach = 4.0;
constexpr double kLeastReach = 12.0;
// Of the ROI's diagonal: how far a region that has been found may have gone by the next image, its motion being unknown.
constexpr double kUnknownMotion = 0.15;
constexpr double kSearchReach = 0.25;  // of the ROI's larger side, when it has been lost

std::string roiText(const geometry::Rectangle& roi) {
  std::ostringstream text;
  text << "ROI x=" << roi.x << " y=" << roi.y << " width=" << roi.width << " height=" << roi.height;
  return text.str();
}

void checkImage(const cv::Mat& image) {
  if (image.empty()) throw std::invalid_argument("image is empty, expected at least one pixel");
  if (image.type() != CV_8UC1 && image.type() != CV_8UC3) {
    throw std::invalid_argument("image of OpenCV type " + std::to_string(image.type()) +
                                ", expected 8 bit with one channel or three");
  }
}

}  // namespace

const char* stateName(State state) {
  switch (state) {
    case State::kIdle: return "IDLE";
    case State::kTracking: return "TRACKING";
    case State::kSearching: return "SEARCHING";
    case State::kLost: return "LOST";
  }
  return "unknown";
}

class RegionTracker::Implementation {
 public:
  explicit Implementation(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens = nullptr)
      : config_(config),
        lens_(lens),
        aligner_(config, lens),
        filter_(config.velocity_damping),
        keyframes_(config.search.keyframes, lens),
        feature_search_(config.search, lens) {}

  void setLens(const std::optional<image::Lens>& lens);
  TrackResult select(const cv::Mat& image, double stamp, const geometry::Rectangle& roi);
  const TrackResult& track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion);
  void reset();
  cv::Mat occlusionMask() const;
  bool hasRoi() const { return state_ != State::kIdle; }
  const TrackerConfig& config() const { return config_; }

 private:
  struct Attempt {
    Evidence evidence;
    std::string doubt;
  };

  geometry::Rectangle checkedRoi(const cv::Mat& image, const geometry::Rectangle& roi) const;
  bool shows(const cv::Mat& image, const geometry::Rectangle& roi) const;
  std::optional<Eigen::Matrix3d> carriedBy(const std::optional<Eigen::Matrix3d>& motion) const;
  Attempt attempt(const cv::Mat& image, double stamp, const EsmState& start, const MotionPrior* prior);
  Attempt search(const cv::Mat& image, double stamp);
  std::vector<Eigen::Matrix3d> searchCoarsely(const cv::Mat& image);
  std::string doubtWhatWasFound(const Attempt& found);
  Eigen::Matrix3d expectedCandidate() const { return geometry::normaliseDeterminant(candidate_.g * candidate_step_); }
  void keepView(const cv::Mat& image, const Attempt& seen);
  void decide(const Attempt& best, const MotionPrior& prior, double stamp);
  const TrackResult& report(const Attempt& attempt);
  const TrackResult& idle(double stamp, const std::string& reason);

  TrackerConfig config_;
  std::shared_ptr<const image::Lens> lens_;  // null: none
  std::string reset_reason_;                 // for the next image
  RegionAligner aligner_;
  MotionFilter filter_;
  Keyframes keyframes_;
  FeatureSearch feature_search_;

  State state_ = State::kIdle;
  cv::Size image_size_;
  double reference_stamp_ = 0.0;
  double last_stamp_ = 0.0;
  EsmState last_;                      // last estimate that was believed
  std::optional<Eigen::Matrix3d> carried_;  // the same, moved as a robot says: where the last attempt started from
  TrackRecord record_;
  int confirmations_ = 0;
  EsmState candidate_;                 // while searching: what is being confirmed
  Eigen::Matrix3d candidate_step_ = Eigen::Matrix3d::Identity();  // by which it came from the image before
  unsigned search_turn_ = 0;           // images searched since the ROI was lost
  TrackResult result_;                 // of the last image
};

geometry::Rectangle RegionTracker::Implementation::checkedRoi(const cv::Mat& image, const geometry::Rectangle& roi) const {
  const std::string name = roiText(roi);
  const std::string size = std::to_string(image.cols) + " x " + std::to_string(image.rows);
  if (!(roi.width >= config_.min_roi_side) || !(roi.height >= config_.min_roi_side)) {
    throw std::invalid_argument(name + " is too small, expected at least " + std::to_string(config_.min_roi_side) +
                                " px in width and height");
  }
  const geometry::Rectangle whole{std::floor(roi.x), std::floor(roi.y), std::floor(roi.width), std::floor(roi.height)};
  if (!shows(image, whole)) {
    throw std::invalid_argument(name + " is not inside the image of " + size + " px" +
                                (lens_ ? ", as its lens shows it: the ROI is in rectified pixels" : ""));
  }
  return whole;
}

// False for NaN.
bool RegionTracker::Implementation::shows(const cv::Mat& image, const geometry::Rectangle& roi) const {
  if (!lens_) {
    return roi.x >= 0.0 && roi.y >= 0.0 && roi.x + roi.width <= image.cols && roi.y + roi.height <= image.rows;
  }
  const double longest_side = 65536.0;
  if (!(roi.width <= longest_side && roi.height <= longest_side)) return false;
  const auto seen = [&](double x, double y) {
    const auto raw = lens_->toRaw(Eigen::Vector2d(x, y));
    return raw && raw->x() >= 0.0 && raw->y() >= 0.0 && raw->x() <= image.cols - 1.0 && raw->y() <= image.rows - 1.0;
  };
  // What is one to one takes the inside of the border to the inside.
  const double right = roi.x + roi.width - 1.0;
  const double bottom = roi.y + roi.height - 1.0;
  for (double x = roi.x; x <= right; x += 1.0) {
    if (!seen(x, roi.y) || !seen(x, bottom)) return false;
  }
  for (double y = roi.y; y <= bottom; y += 1.0) {
    if (!seen(roi.x, y) || !seen(right, y)) return false;
  }
  return std::isfinite(right) && std::isfinite(bottom);
}

void RegionTracker::Implementation::setLens(const std::optional<image::Lens>& lens) {
  const bool same = lens ? lens_ && *lens_ == *lens : !lens_;
  if (same) return;
  const bool had_roi = hasRoi();
  *this = Implementation(config_, lens ? std::make_shared<const image::Lens>(*lens) : nullptr);
  if (had_roi) reset_reason_ = "the lens changed since the ROI was selected: select it again";
}

TrackResult RegionTracker::Implementation::select(const cv::Mat& image, double stamp, const geometry::Rectangle& wanted) {
  checkImage(image);
  const geometry::Rectangle roi = checkedRoi(image, wanted);

  // Everything is built aside, so that a ROI that is refused leaves the tracker as it was.
  Implementation fresh(config_, lens_);
  fresh.aligner_.setReference(image, roi);
  const double error = fresh.aligner_.referenceCornerError(kTypicalNoise);
  if (!(error <= config_.min_texture)) {
    std::ostringstream message;
    message.precision(3);
    message << roiText(roi) << " has too little texture: " << kTypicalNoise << " grey levels of noise would move a corner by "
            << error << " px, expected at most " << config_.min_texture;
    throw std::invalid_argument(message.str());
  }
  fresh.keyframes_.setReference(image, roi, fresh.aligner_.weights());
  fresh.filter_.start(roi, fresh.aligner_.esm().normalisation(), stamp);
  fresh.state_ = State::kTracking;
  fresh.image_size_ = image.size();
  fresh.reference_stamp_ = fresh.last_stamp_ = stamp;
  *this = std::move(fresh);

  Attempt attempt;
  attempt.evidence.roi = roi;
  attempt.evidence.esm.status = EsmStatus::kConverged;
  attempt.evidence.esm.corner_error = error;
  attempt.evidence.visible_fraction = cv::sum(aligner_.weights())[0] / roi.width / roi.height;
  attempt.evidence.zncc = 1.0;
  TrackResult result = report(attempt);
  result.selected_now = true;
  return result;
}

const TrackResult& RegionTracker::Implementation::track(const cv::Mat& image, double stamp,
                                                 const std::optional<Eigen::Matrix3d>& motion) {
  checkImage(image);
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
    why << "image size changed from " << image_size_.width << " x " << image_size_.height << " to " << image.cols << " x "
        << image.rows << " px";
  }
  if (!why.str().empty()) {
    reset();
    return idle(stamp, why.str());
  }
  carried_ = carriedBy(motion);
  MotionPrior prior = filter_.predict(stamp, carried_);
  Attempt best;
  if (state_ == State::kTracking) {
    EsmState start = last_;
    start.g = prior.predicted;
    best = attempt(image, stamp, start, &prior);
    if (carried_ && !best.doubt.empty()) {
      // A robot that is wrong must not lose what is found without it; what was seen where it led says nothing.
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
  keepView(image, best);
  aligner_.advance();
  last_stamp_ = stamp;
  return report(best);
}

// Where the last estimate is by what a robot says; empty when that is no motion that could be one.
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
RegionTracker::Implementation::Attempt RegionTracker::Implementation::attempt(const cv::Mat& image, double stamp,
                                                                              const EsmState& start,
                                                                              const MotionPrior* prior) {
  const geometry::Rectangle& roi = aligner_.roi();
  const double reach = prior != nullptr ? std::max(kLeastReach, kReach * record_.innovation())
                                        : std::max(32.0, kSearchReach * std::max(roi.width, roi.height));
  const Alignment found = aligner_.align(image, start, prior, reach);
  Attempt result;
  Evidence& e = result.evidence;
  e.roi = roi;
  e.predicted = start.g;
  e.from_track = prior != nullptr;
  e.last_gain = last_.gain;
  e.unseen = stamp - filter_.lastStamp();
  e.record = record_;
  e.esm = found.esm;
  e.visible_fraction = found.visible_fraction;
  e.in_image = found.share_in_image;
  e.zncc = found.zncc;
  result.doubt = found.in_image ? doubt(e, config_.quality) : "the ROI is outside the image";
  return result;
}

// What the last image suggested comes first, then where the ROI was last seen, then what points suggest, or, in turn with them,
// what correlates anywhere in the image: one of both an image, so that the time is bounded.
RegionTracker::Implementation::Attempt RegionTracker::Implementation::search(const cv::Mat& image, double stamp) {
  Attempt best;
  const auto tryAt = [&](const EsmState& start) {
    aligner_.startAfresh();
    best = attempt(image, stamp, start, nullptr);
    if (best.doubt.empty()) best.doubt = doubtWhatWasFound(best);
    return best.doubt.empty();
  };
  const auto tryEach = [&](const std::vector<Eigen::Matrix3d>& places) {
    EsmState start = last_;
    for (const Eigen::Matrix3d& g : places) {
      start.g = g;
      if (tryAt(start)) return true;
    }
    return false;
  };
  const std::optional<Eigen::Matrix3d> moved = carried_;
  carried_.reset();
  if (confirmations_ > 0) {
    EsmState start = candidate_;
    start.g = expectedCandidate();
    if (tryAt(start)) return best;
  }
  if (moved) {
    carried_ = moved;
    if (tryEach({*moved})) return best;
    carried_.reset();
  }
  if (tryAt(last_)) return best;
  const SearchConfig& stages = config_.search;
  const bool features = stages.features && (!stages.correlation || search_turn_ % 2 == 0);
  ++search_turn_;
  if (features) {
    std::vector<Eigen::Matrix3d> places;
    for (const FeatureCandidate& candidate : feature_search_.find(image, aligner_.channels().weights[0], keyframes_)) {
      if (static_cast<int>(places.size()) < kSearchCandidates) places.push_back(candidate.g);
    }
    tryEach(places);
  } else if (stages.correlation) {
    tryEach(searchCoarsely(image));
  }
  return best;
}

// A search asks at many places, so that one of them may pass by chance what a tracked region passes by right: more is asked.
std::string RegionTracker::Implementation::doubtWhatWasFound(const Attempt& found) {
  const double detail = aligner_.detail();
  std::ostringstream why;
  why.precision(3);
  if (found.evidence.esm.status != EsmStatus::kConverged) {
    why << "still moving where it was searched";
  } else if (!(detail >= config_.search.min_detail)) {
    why << "correlation of details " << detail << " where it was searched, expected at least " << config_.search.min_detail;
  }
  return why.str();
}

std::vector<Eigen::Matrix3d> RegionTracker::Implementation::searchCoarsely(const cv::Mat& image) {
  const int l = aligner_.esm().levels() - 1;
  image::RegionPyramid whole;
  whole.build(image, cv::Rect(0, 0, image.cols, image.rows), l + 1, aligner_.channels().weights[0]);
  const EsmLevel& level = aligner_.esm().level(l);
  cv::Mat1f coarse = whole.level(l);
  Eigen::Matrix3d from_coarse = Eigen::Matrix3d::Identity();  // its first pixel to that of the image
  if (lens_) {
    const cv::Rect box = image::rectifiedBox(*lens_, image.size());
    from_coarse.topRightCorner<2, 1>() << box.x, box.y;
    Eigen::Matrix3d sampling = from_coarse;
    sampling.topLeftCorner<2, 2>() *= level.scale;
    const cv::Size size(static_cast<int>(box.width / level.scale) + 1, static_cast<int>(box.height / level.scale) + 1);
    coarse = cv::Mat1f(size);
    cv::Mat1f valid(size);
    image::warpBilinear(whole.level(l), sampling, *lens_, {cv::Point(0, 0), level.scale}, coarse, valid);
    coarse.setTo(0.0f, valid == 0.0f);
  }
  std::vector<Eigen::Matrix3d> places;
  for (const Candidate& candidate :
       searchByCorrelation(level.planes[0].value.view(), level.image_T_patch, coarse, level.scale, aligner_.roi(),
                           from_coarse.inverse() * last_.g, kSearchCandidates)) {
    places.push_back(from_coarse * candidate.g);
  }
  return places;
}

void RegionTracker::Implementation::keepView(const cv::Mat& image, const Attempt& seen) {
  const Evidence& e = seen.evidence;
  if (state_ != State::kTracking || !(e.visible_fraction >= kKeyframeVisible) || !(e.zncc >= kKeyframeZncc)) return;
  if (config_.search.features && keyframes_.wants(last_.g)) keyframes_.add(image, last_.g, aligner_.weights());
}

void RegionTracker::Implementation::decide(const Attempt& best, const MotionPrior& prior, double stamp) {
  const QualityConfig& quality = config_.quality;
  const Evidence& e = best.evidence;
  if (!best.doubt.empty()) {
    confirmations_ = 0;
    filter_.stop();
    if (state_ == State::kTracking) {
      state_ = State::kSearching;
      search_turn_ = 0;
      feature_search_.restart();
    }
    if (stamp - filter_.lastStamp() > quality.max_search_time) state_ = State::kLost;
    return;
  }
  if (state_ != State::kTracking) {
    // False fits do not come back to the same place, nor go on as they went; the target may have been moving all the time.
    if (confirmations_ > 0) {
      const double apart = farthestCorner(expectedCandidate(), e.esm.state.g, aligner_.roi());
      const double share = confirmations_ == 1 ? kUnknownMotion : 0.0;
      const double unknown = share * std::hypot(aligner_.roi().width, aligner_.roi().height);
      const double allowed = allowedJump(record_, quality, aligner_.roi(), 0.0, e.esm.corner_error);
      if (!(apart <= std::max(allowed, unknown))) confirmations_ = 0;
    }
    candidate_step_ = confirmations_ > 0 ? Eigen::Matrix3d(candidate_.g.inverse() * e.esm.state.g) : Eigen::Matrix3d::Identity();
    ++confirmations_;
    candidate_ = e.esm.state;
    if (confirmations_ < quality.confirmations) return;
    state_ = State::kTracking;
    filter_.restart(e.esm, stamp);
  } else {
    record_.add(e.zncc, e.esm.sigma, farthestCorner(e.predicted, e.esm.state.g, aligner_.roi()), e.visible_fraction);
    filter_.update(prior, e.esm, stamp, e.visible_fraction >= kRecordVisible, carried_);
  }
  confirmations_ = 0;
  last_ = e.esm.state;
}

// Keeps the memory of the result before.
const TrackResult& RegionTracker::Implementation::report(const Attempt& attempt) {
  TrackResult& result = result_;
  result.reason = attempt.doubt;
  result.state = state_;
  if (state_ != State::kTracking && attempt.doubt.empty()) result.reason = "found, waits for confirmation";
  result.g = state_ == State::kTracking ? last_.g : (confirmations_ > 0 ? candidate_.g : last_.g);
  result.roi = aligner_.roi();
  result.reference_stamp = reference_stamp_;
  result.visible_fraction = attempt.evidence.visible_fraction;
  result.zncc = attempt.evidence.zncc;
  result.iterations = attempt.evidence.esm.iterations;
  result.corner_error = attempt.evidence.esm.corner_error;
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
  for (int area = 0; area < grid.count(); ++area) result.areas.occluded[area] = gates.occluded(area);
  return result;
}

const TrackResult& RegionTracker::Implementation::idle(double stamp, const std::string& reason) {
  result_ = TrackResult();
  result_.reason = reason;
  result_.reference_stamp = stamp;
  return result_;
}

void RegionTracker::Implementation::reset() { *this = Implementation(config_, lens_); }

cv::Mat RegionTracker::Implementation::occlusionMask() const {
  if (state_ == State::kIdle) return {};
  const OcclusionGates& gates = aligner_.gates();
  const image::AreaGrid& grid = gates.grid();
  cv::Mat1b areas(grid.height(), grid.width());
  for (int j = 0; j < grid.height(); ++j) {
    for (int i = 0; i < grid.width(); ++i) areas(j, i) = gates.occluded(grid.areaOf(i, j)) ? 255 : 0;
  }
  const Eigen::Matrix3d g = state_ == State::kTracking || confirmations_ == 0 ? last_.g : candidate_.g;
  const geometry::Quadrilateral corners = geometry::apply(g, aligner_.roi().corners());
  cv::Mat1b mask = cv::Mat1b::zeros(image_size_);
  const cv::Rect box = image::seenBox(lens_.get(), corners, 1.0) & cv::Rect(cv::Point(0, 0), image_size_);
  if (box.empty()) return mask;
  cv::Mat1b part = mask(box);
  image::drawMask(areas, g * imageFromPatch(aligner_.roi()), lens_.get(), box, part);
  return mask;
}

RegionTracker::RegionTracker(const TrackerConfig& config) {
  const std::vector<std::string> errors = validate(config);
  if (!errors.empty()) {
    std::string message = "tracker configuration:";
    for (const std::string& error : errors) message += "\n  " + error;
    throw std::invalid_argument(message);
  }
  implementation_ = std::make_unique<Implementation>(config);
}

RegionTracker::~RegionTracker() = default;
RegionTracker::RegionTracker(RegionTracker&&) noexcept = default;
RegionTracker& RegionTracker::operator=(RegionTracker&&) noexcept = default;

void RegionTracker::setLens(const std::optional<image::Lens>& lens) { implementation_->setLens(lens); }

TrackResult RegionTracker::select(const cv::Mat& image, double stamp, const geometry::Rectangle& roi) {
  return implementation_->select(image, stamp, roi);
}
const TrackResult& RegionTracker::track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion) {
  return implementation_->track(image, stamp, motion);
}
void RegionTracker::reset() { implementation_->reset(); }
cv::Mat RegionTracker::occlusionMask() const { return implementation_->occlusionMask(); }
bool RegionTracker::hasRoi() const { return implementation_->hasRoi(); }
const TrackerConfig& RegionTracker::config() const { return implementation_->config(); }

}  // namespace laparoscope_servo::tracking
