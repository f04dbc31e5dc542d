#include "laparoscope_servo/tracking/region_tracker.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <stdexcept>

#include "laparoscope_servo/geometry/sl3.h"
#include "laparoscope_servo/image/colour_patch.h"
#include "laparoscope_servo/image/pyramid.h"
#include "laparoscope_servo/image/warp.h"
#include "laparoscope_servo/tracking/detail.h"
#include "laparoscope_servo/tracking/esm.h"
#include "laparoscope_servo/tracking/feature_search.h"
#include "laparoscope_servo/tracking/keyframes.h"
#include "laparoscope_servo/tracking/occlusion_gates.h"
#include "laparoscope_servo/tracking/quality.h"
#include "laparoscope_servo/tracking/relocalisation.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr double kTypicalNoise = 2.0;    // grey levels, of a laparoscope's camera
constexpr int kSearchCandidates = 2;  // that are aligned, of each stage of the search
// A view is worth storing that was seen nearly whole, and clearly.
constexpr double kKeyframeVisible = 0.7;
constexpr double kKeyframeZncc = 0.85;
constexpr int kMaxStructureRounds = 3;
constexpr double kGateShift = 2.0;       // px: masks drawn further from the estimate than this are drawn again

// Pixels of the ROI to those of the image.
Eigen::Matrix3d fromPatch(const geometry::Rectangle& roi) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m.topRightCorner<2, 1>() << roi.x, roi.y;
  return m;
}

double farthestCorner(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b, const geometry::Rectangle& roi) {
  const geometry::Quadrilateral p = geometry::apply(a, roi.corners());
  const geometry::Quadrilateral q = geometry::apply(b, roi.corners());
  double distance = 0.0;
  for (int k = 0; k < 4; ++k) distance = std::max(distance, (p[k] - q[k]).norm());
  return distance;
}

// The combination of the channels whose gradient is strongest for its noise: the principal axis of sum grad_c grad_d. Scaled
// so that the weights' magnitudes sum to one, which keeps the range of grey levels.
image::ChannelWeights strongestChannel(const cv::Mat& patch) {
  cv::Mat3f gx, gy, smooth;
  patch.convertTo(smooth, CV_32FC3);
  cv::GaussianBlur(smooth, smooth, cv::Size(), 1.0);
  cv::Sobel(smooth, gx, CV_32F, 1, 0, 1, 0.5);
  cv::Sobel(smooth, gy, CV_32F, 0, 1, 1, 0.5);
  Eigen::Matrix3d energy = Eigen::Matrix3d::Zero();
  for (int j = 0; j < patch.rows; ++j) {
    for (int i = 0; i < patch.cols; ++i) {
      const Eigen::Vector3d x(gx(j, i)[0], gx(j, i)[1], gx(j, i)[2]);
      const Eigen::Vector3d y(gy(j, i)[0], gy(j, i)[1], gy(j, i)[2]);
      energy += x * x.transpose() + y * y.transpose();
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(energy);
  Eigen::Vector3d axis = solver.eigenvectors().col(2);
  const double magnitude = axis.cwiseAbs().sum();
  if (solver.info() != Eigen::Success || !(magnitude > 0.0)) return image::kLuma;
  axis *= (axis.sum() < 0.0 ? -1.0 : 1.0) / magnitude;
  return {static_cast<float>(axis[0]), static_cast<float>(axis[1]), static_cast<float>(axis[2])};
}

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
        esm_(config.esm, lens),
        gates_(config.occlusion, config.esm.saturation),
        keyframes_(config.search.keyframes, lens),
        feature_search_(config.search, lens) {}

  void setLens(const std::optional<image::Lens>& lens);

  TrackResult select(const cv::Mat& image, double stamp, const geometry::Rectangle& roi);
  TrackResult track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion);
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
  cv::Rect seenBox(const geometry::Quadrilateral& corners, double margin) const {
    return image::seenBox(lens_.get(), corners, margin);
  }
  void drawPatch(const cv::Mat& image, const Eigen::Matrix3d& g, const geometry::Rectangle& roi);
  Eigen::Matrix3d predict(double stamp) const;
  bool carry(const std::optional<Eigen::Matrix3d>& motion);
  Attempt attempt(const cv::Mat& image, const EsmState& start, bool from_track);
  Attempt search(const cv::Mat& image);
  std::vector<Eigen::Matrix3d> searchCoarsely(const cv::Mat& image);
  std::string doubtWhatWasFound(const Attempt& found);
  void keepView(const cv::Mat& image, const Attempt& seen);
  void look(const cv::Mat& image, const Eigen::Matrix3d& g);
  void decide(const Attempt& best, double stamp);
  TrackResult report(const Attempt& attempt, double stamp) const;
  TrackResult idle(double stamp, const std::string& reason) const;

  TrackerConfig config_;
  std::shared_ptr<const image::Lens> lens_;  // null: none
  std::string reset_reason_;                 // for the next image
  Esm esm_;
  OcclusionGates gates_;
  image::RegionPyramid pyramid_;
  image::ChannelWeights channel_ = image::kLuma;
  image::ColourPatch patch_;
  Keyframes keyframes_;
  FeatureSearch feature_search_;

  State state_ = State::kIdle;
  cv::Size image_size_;
  double reference_stamp_ = 0.0;
  double last_stamp_ = 0.0;
  EsmState last_;                      // last estimate that was believed
  Eigen::Matrix3d carried_ = Eigen::Matrix3d::Identity();  // the same, moved by what the robot says
  bool is_carried_ = false;
  geometry::Vector8d rest_velocity_ =
      geometry::Vector8d::Zero();  // as velocity_, of what remained beside the robot's motion
  bool has_rest_velocity_ = false;
  double last_good_stamp_ = 0.0;
  geometry::Vector8d velocity_ = geometry::Vector8d::Zero();  // 1/s, of the last motion, in normalised template coordinates
  bool has_velocity_ = false;
  TrackRecord record_;
  int confirmations_ = 0;
  EsmState candidate_;                 // while searching: what is being confirmed
  unsigned search_turn_ = 0;           // images searched since the ROI was lost
  Eigen::Matrix3d n_ = Eigen::Matrix3d::Identity();  // N, see Esm
  Eigen::Matrix3d shown_ = Eigen::Matrix3d::Identity();
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
  if (!lens_)
    return roi.x >= 0.0 && roi.y >= 0.0 && roi.x + roi.width <= image.cols && roi.y + roi.height <= image.rows;
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

void RegionTracker::Implementation::drawPatch(const cv::Mat& image, const Eigen::Matrix3d& g,
                                              const geometry::Rectangle& roi) {
  const cv::Size size(static_cast<int>(roi.width), static_cast<int>(roi.height));
  if (lens_) {
    image::warpNearest(image, g * fromPatch(roi), *lens_, size, patch_);
  } else {
    image::warpNearest(image, g * fromPatch(roi), size, patch_);
  }
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
  const cv::Rect box = seenBox(roi.corners(), 0.0) & cv::Rect(cv::Point(0, 0), image.size());
  if (image.channels() == 3 && config_.esm.adapt_channel) fresh.channel_ = strongestChannel(image(box));
  fresh.pyramid_.build(image, seenBox(roi.corners(), 4.0 * (1 << config_.esm.levels)), config_.esm.levels,
                       fresh.channel_);
  fresh.esm_.setReference(fresh.pyramid_, roi);
  fresh.drawPatch(image, Eigen::Matrix3d::Identity(), roi);
  fresh.gates_.setReference(fresh.patch_);
  fresh.esm_.setWeights(fresh.gates_.weights());
  const double error = fresh.esm_.referenceCornerError(kTypicalNoise);
  if (!(error <= config_.min_texture)) {
    std::ostringstream message;
    message.precision(3);
    message << roiText(roi) << " has too little texture: " << kTypicalNoise << " grey levels of noise would move a corner by "
            << error << " px, expected at most " << config_.min_texture;
    throw std::invalid_argument(message.str());
  }
  fresh.keyframes_.setReference(image, roi, fresh.gates_.weights());
  fresh.state_ = State::kTracking;
  fresh.image_size_ = image.size();
  fresh.reference_stamp_ = fresh.last_stamp_ = fresh.last_good_stamp_ = stamp;
  fresh.n_ = fresh.esm_.normalisation();
  *this = std::move(fresh);

  Attempt attempt;
  attempt.evidence.roi = roi;
  attempt.evidence.esm.status = EsmStatus::kConverged;
  attempt.evidence.esm.corner_error = error;
  attempt.evidence.visible_fraction = cv::sum(gates_.weights())[0] / roi.width / roi.height;
  attempt.evidence.zncc = 1.0;
  TrackResult result = report(attempt, stamp);
  result.selected_now = true;
  return result;
}

TrackResult RegionTracker::Implementation::track(const cv::Mat& image, double stamp,
                                                 const std::optional<Eigen::Matrix3d>& motion) {
  checkImage(image);
  if (state_ == State::kIdle) {
    const TrackResult result = idle(stamp, reset_reason_.empty() ? "no region of interest selected" : reset_reason_);
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
  Attempt best;
  const bool moved = carry(motion);
  if (state_ == State::kTracking) {
    EsmState start = last_;
    start.g = predict(stamp);
    best = attempt(image, start, true);
    if (moved && !best.doubt.empty()) {
      // A robot that is wrong must not lose what is found without it; what was seen where it led says nothing.
      carry(std::nullopt);
      gates_.forget();
      esm_.forgetLight();
      start.g = predict(stamp);
      best = attempt(image, start, true);
    }
  } else {
    best = search(image);
  }
  decide(best, stamp);
  keepView(image, best);
  gates_.advance();
  last_stamp_ = stamp;
  return report(best, stamp);
}

// False when there is no motion that could be one.
bool RegionTracker::Implementation::carry(const std::optional<Eigen::Matrix3d>& motion) {
  carried_ = last_.g;
  is_carried_ = false;
  if (!motion || !motion->allFinite() || !(motion->determinant() > 1e-12)) return false;
  const Eigen::Matrix3d g = geometry::normaliseDeterminant(*motion * last_.g);
  const geometry::Quadrilateral corners = geometry::apply(g, esm_.roi().corners());
  const double ratio = geometry::signedArea(corners) / geometry::signedArea(esm_.roi().corners());
  if (!geometry::isConvex(corners) || !(std::max(ratio, 1.0 / ratio) <= config_.quality.max_area_ratio)) return false;
  carried_ = g;
  is_carried_ = true;
  return true;
}

Eigen::Matrix3d RegionTracker::Implementation::predict(double stamp) const {
  const double dt = stamp - last_good_stamp_;
  if (!(is_carried_ ? has_rest_velocity_ : has_velocity_) || !(dt > 0.0)) return carried_;
  const Eigen::Matrix3d motion =
      geometry::sl3Exp(config_.velocity_damping * dt * (is_carried_ ? rest_velocity_ : velocity_));
  const Eigen::Matrix3d g = carried_ * n_.inverse() * motion * n_;
  return geometry::isConvex(geometry::apply(g, esm_.roi().corners())) ? g : carried_;
}

// The gates' view of the image where the ROI is taken to be.
void RegionTracker::Implementation::look(const cv::Mat& image, const Eigen::Matrix3d& g) {
  drawPatch(image, g, esm_.roi());
  gates_.observeColour(patch_);
  esm_.setWeights(gates_.weights());
  shown_ = g;
}

RegionTracker::Implementation::Attempt RegionTracker::Implementation::attempt(const cv::Mat& image, const EsmState& start,
                                                                              bool from_track) {
  const geometry::Rectangle& roi = esm_.roi();
  Attempt result;
  Evidence& e = result.evidence;
  e.roi = roi;
  e.predicted = start.g;
  e.from_track = from_track;
  e.last_gain = last_.gain;
  e.record = record_;
  e.esm.state = start;
  e.esm.status = EsmStatus::kOutOfView;
  const cv::Rect box =
      seenBox(geometry::apply(start.g, roi.corners()), std::max(32.0, 0.25 * std::max(roi.width, roi.height)));
  if ((box & cv::Rect(cv::Point(0, 0), image.size())).empty()) {
    result.doubt = "the ROI is outside the image";
    return result;
  }
  pyramid_.build(image, box, config_.esm.levels, channel_);
  look(image, start.g);
  e.esm = esm_.align(pyramid_, start);
  int iterations = e.esm.iterations;
  const auto refine = [&] {
    e.esm = esm_.align(pyramid_, e.esm.state, 0, 0);
    iterations += e.esm.iterations;
  };
  const auto usable = [&] { return e.esm.status == EsmStatus::kConverged || e.esm.status == EsmStatus::kMaxIterations; };
  if (usable() && farthestCorner(shown_, e.esm.state.g, roi) > kGateShift) {
    look(image, e.esm.state.g);
    refine();
  }
  for (int round = 0; round < kMaxStructureRounds && usable(); ++round) {
    const EsmLevel& level = esm_.level(0);
    if (gates_.observeStructure(level.warped, level.value, level.valid, e.esm.state.gain, e.esm.sigma) == 0) break;
    esm_.setWeights(gates_.weights());
    refine();
  }
  e.esm.iterations = iterations;
  if (usable()) {
    e.visible_fraction = gates_.visibleFraction();
    e.zncc = gates_.correlation();
  }
  result.doubt = doubt(e, config_.quality);
  return result;
}

// What the last image suggested comes first, then where the ROI was last seen, then what points suggest, or, in turn with them,
// what correlates anywhere in the image: one of both an image, so that the time is bounded.
RegionTracker::Implementation::Attempt RegionTracker::Implementation::search(const cv::Mat& image) {
  Attempt best;
  const auto tryAt = [&](const EsmState& start) {
    gates_.forget();
    esm_.forgetLight();  // of an alignment elsewhere
    best = attempt(image, start, false);
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
  const bool moved = is_carried_;
  is_carried_ = false;
  if (confirmations_ > 0 && tryAt(candidate_)) return best;
  if (moved) {
    is_carried_ = true;
    if (tryEach({carried_})) return best;
    is_carried_ = false;
  }
  if (tryAt(last_)) return best;
  const SearchConfig& stages = config_.search;
  const bool features = stages.features && (!stages.correlation || search_turn_ % 2 == 0);
  ++search_turn_;
  if (features) {
    std::vector<Eigen::Matrix3d> places;
    for (const FeatureCandidate& candidate : feature_search_.find(image, channel_, keyframes_)) {
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
  const EsmLevel& level = esm_.level(0);
  const double detail = detailCorrelation(level.warped.view(), level.value.view(), level.weight.view().mul(level.valid.view()));
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
  const int l = esm_.levels() - 1;
  image::RegionPyramid whole;
  whole.build(image, cv::Rect(0, 0, image.cols, image.rows), l + 1, channel_);
  const EsmLevel& level = esm_.level(l);
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
       searchByCorrelation(level.value.view(), level.image_T_patch, coarse, level.scale, esm_.roi(),
                           from_coarse.inverse() * last_.g, kSearchCandidates)) {
    places.push_back(from_coarse * candidate.g);
  }
  return places;
}

void RegionTracker::Implementation::keepView(const cv::Mat& image, const Attempt& seen) {
  const Evidence& e = seen.evidence;
  if (state_ != State::kTracking || !(e.visible_fraction >= kKeyframeVisible) || !(e.zncc >= kKeyframeZncc)) return;
  if (config_.search.features && keyframes_.wants(last_.g)) keyframes_.add(image, last_.g, gates_.weights());
}

void RegionTracker::Implementation::decide(const Attempt& best, double stamp) {
  const QualityConfig& quality = config_.quality;
  if (!best.doubt.empty()) {
    confirmations_ = 0;
    has_velocity_ = has_rest_velocity_ = false;
    if (state_ == State::kTracking) {
      state_ = State::kSearching;
      search_turn_ = 0;
      feature_search_.restart();
    }
    if (stamp - last_good_stamp_ > quality.max_search_time) state_ = State::kLost;
    return;
  }
  const EsmState& now = best.evidence.esm.state;
  if (state_ != State::kTracking) {
    // False fits do not come back to the same place.
    const double apart = confirmations_ == 0 ? 0.0 : farthestCorner(candidate_.g, now.g, esm_.roi());
    const bool agrees = apart <= allowedJump(record_, quality, esm_.roi(), 0.0, best.evidence.esm.corner_error);
    confirmations_ = agrees ? confirmations_ + 1 : 1;
    candidate_ = now;
    if (confirmations_ < quality.confirmations) return;
    state_ = State::kTracking;
    has_velocity_ = has_rest_velocity_ = false;
  } else {
    record_.add(best.evidence.zncc, best.evidence.esm.sigma, farthestCorner(best.evidence.predicted, now.g, esm_.roi()),
                best.evidence.visible_fraction);
    const double dt = stamp - last_good_stamp_;
    has_velocity_ = dt > 0.0;
    if (has_velocity_) {
      velocity_ = geometry::sl3Log(geometry::normaliseDeterminant(n_ * last_.g.inverse() * now.g * n_.inverse())) / dt;
      has_velocity_ = velocity_.allFinite();
    }
    has_rest_velocity_ = is_carried_ && dt > 0.0;
    if (has_rest_velocity_) {
      rest_velocity_ =
          geometry::sl3Log(geometry::normaliseDeterminant(n_ * carried_.inverse() * now.g * n_.inverse())) / dt;
      has_rest_velocity_ = rest_velocity_.allFinite();
    }
  }
  confirmations_ = 0;
  last_ = now;
  last_good_stamp_ = stamp;
}

TrackResult RegionTracker::Implementation::report(const Attempt& attempt, double stamp) const {
  TrackResult result = idle(stamp, attempt.doubt);
  result.state = state_;
  if (state_ != State::kTracking && attempt.doubt.empty()) result.reason = "found, waits for confirmation";
  result.g = state_ == State::kTracking ? last_.g : (confirmations_ > 0 ? candidate_.g : last_.g);
  result.roi = esm_.roi();
  result.reference_stamp = reference_stamp_;
  result.visible_fraction = attempt.evidence.visible_fraction;
  result.zncc = attempt.evidence.zncc;
  result.iterations = attempt.evidence.esm.iterations;
  result.corner_error = attempt.evidence.esm.corner_error;
  result.sigma = attempt.evidence.esm.sigma;
  result.motion_used = is_carried_ && attempt.doubt.empty();
  result.gain = attempt.evidence.esm.state.gain;
  result.bias = attempt.evidence.esm.state.bias;
  result.colour_used = gates_.colourUsed();
  const image::AreaGrid& grid = gates_.grid();
  result.areas = {grid.rows(), grid.columns(), gates_.distances(), std::vector<bool>(grid.count())};
  for (int area = 0; area < grid.count(); ++area) result.areas.occluded[area] = gates_.occluded(area);
  return result;
}

TrackResult RegionTracker::Implementation::idle(double stamp, const std::string& reason) const {
  TrackResult result;
  result.reason = reason;
  result.reference_stamp = stamp;
  return result;
}

void RegionTracker::Implementation::reset() {
  *this = Implementation(config_, lens_);
}

cv::Mat RegionTracker::Implementation::occlusionMask() const {
  if (state_ == State::kIdle) return {};
  const image::AreaGrid& grid = gates_.grid();
  cv::Mat1b areas(grid.height(), grid.width());
  for (int j = 0; j < grid.height(); ++j) {
    for (int i = 0; i < grid.width(); ++i) areas(j, i) = gates_.occluded(grid.areaOf(i, j)) ? 255 : 0;
  }
  const Eigen::Matrix3d g = state_ == State::kTracking || confirmations_ == 0 ? last_.g : candidate_.g;
  cv::Mat1b mask = cv::Mat1b::zeros(image_size_);
  const cv::Rect box = seenBox(geometry::apply(g, esm_.roi().corners()), 1.0) & cv::Rect(cv::Point(0, 0), image_size_);
  if (box.empty()) return mask;
  cv::Mat1b part = mask(box);
  image::drawMask(areas, g * fromPatch(esm_.roi()), lens_.get(), box, part);
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

void RegionTracker::setLens(const std::optional<image::Lens>& lens) {
  implementation_->setLens(lens);
}

TrackResult RegionTracker::select(const cv::Mat& image, double stamp, const geometry::Rectangle& roi) {
  return implementation_->select(image, stamp, roi);
}
TrackResult RegionTracker::track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion) {
  return implementation_->track(image, stamp, motion);
}
void RegionTracker::reset() { implementation_->reset(); }
cv::Mat RegionTracker::occlusionMask() const { return implementation_->occlusionMask(); }
bool RegionTracker::hasRoi() const { return implementation_->hasRoi(); }
const TrackerConfig& RegionTracker::config() const { return implementation_->config(); }

}  // namespace laparoscope_servo::tracking
