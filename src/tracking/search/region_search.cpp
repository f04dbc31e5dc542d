#include "tracking/search/region_search.h"

#include <Eigen/LU>
#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "laparoscope_servo/image/warp.h"
#include "tracking/search/search_budget.h"
#include "tracking/search/template_search.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr double kUsualWork = 10.0;     // EsmResult::work of a usual alignment, which each gets in its image
constexpr int kMostResumed = 2;         // further images in which an interrupted alignment goes on
constexpr std::size_t kCandidates = 2;  // places that are tried from each stage of the search
constexpr double kAround = 2.25;        // an alignment takes in so many times the ROI's pixels
constexpr double kSlidingScale = 4.0;   // px of the image per px of the coarse image of the template search, about
// Least correlation of a start that is worth an alignment. Of 4,800 alignments on eight films, one in 3,200 of those
// from a lower correlation led to the true place; a half-covered ROI correlates with 0.3 or more (see bench_returns).
constexpr double kWorthAligning = 0.25;
// A keyframe is stored only if the ROI was almost wholly visible and correlated well.
constexpr double kKeyframeVisible = 0.7;
constexpr double kKeyframeZncc = 0.85;
// The most recent keyframe may be worse, since it is there for tissue that has changed.
constexpr double kRecentVisible = 0.5;
constexpr double kRecentAge = 0.4;  // s

}  // namespace

RegionSearch::RegionSearch(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens)
    : config_(config),
      lens_(lens),
      keyframes_(config.search.keyframes, lens),
      feature_search_(config, lens),
      start_check_(lens) {}

void RegionSearch::setReference(const cv::Mat& image, RegionAligner& aligner) {
  keyframes_.setReference(image, aligner.roi(), aligner.weights());
  start_check_.setReference(image, aligner.roi(), aligner.channels().weights[0]);
}

void RegionSearch::keepKeyframe(const cv::Mat& image, double stamp, const Evidence& seen, const Eigen::Matrix3d& g,
                                RegionAligner& aligner) {
  if (!config_.search.features) return;
  const bool clear = seen.visible_fraction >= kKeyframeVisible && seen.zncc >= kKeyframeZncc;
  if (clear && keyframes_.wants(g)) keyframes_.add(image, g, aligner.weights());
  if (!recent_stamp_) recent_stamp_ = stamp;
  if (stamp - *recent_stamp_ < kRecentAge || !(seen.visible_fraction >= kRecentVisible)) return;
  keyframes_.addRecent(image, g, aligner.weights());
  recent_stamp_ = stamp;
}

void RegionSearch::retune(const TrackerConfig& config) {
  config_ = config;
  feature_search_.retune(config);
}

void RegionSearch::restart() {
  feature_search_.restart();
  suggested_.clear();
  passing_ = to_slide_ = false;
  worked_ = true;  // the first image tries the last place before it begins a pass
}

// The order of the places: the candidate of the last image, then places of earlier images for which there was no time,
// then the place by the ego-motion, then that of the last accepted estimate.
void RegionSearch::begin(const EsmState& last, const std::optional<Eigen::Matrix3d>& carried,
                         const std::optional<EsmState>& awaited) {
  budget_.start(config_.search.budget);
  last_ = last;
  began_ = false;
  best_ = Attempt();
  likeliest_ = 0.0;
  best_by_ = Suggestion::kLast;
  aligned_ = false;
  hungry_ = !worked_ && !awaited;
  worked_ = false;
  const auto stale = [&](const SearchPlace& place) {
    const bool searched = place.by == Suggestion::kFeatures || place.by == Suggestion::kCorrelation;
    return awaited || !(searched || place.resumed > 0);
  };
  suggested_.erase(std::remove_if(suggested_.begin(), suggested_.end(), stale), suggested_.end());
  if (awaited) suggested_.push_back({*awaited, Suggestion::kConfirmation});
  if (carried) suggest(*carried, Suggestion::kCarried);
  suggest(last.g, Suggestion::kLast);
}

void RegionSearch::suggest(const Eigen::Matrix3d& g, Suggestion by) {
  EsmState start = last_;
  start.g = g;
  suggested_.push_back({start, by});
}

// If the suggested places use up the budget, every second image starts with a piece of the pass, so that it gets done.
std::optional<SearchPlace> RegionSearch::next(const cv::Mat& image, const RegionAligner& aligner) {
  if (hungry_) work(image, aligner);
  hungry_ = false;
  while (true) {
    const std::optional<SearchPlace> place = nextSuggested(image);
    if (place) return place;
    if (!suggested_.empty() || !work(image, aligner)) break;
  }
  if (!aligned_) best_.doubt = whyNone();
  return std::nullopt;
}

// The reason why no alignment was tried.
std::string RegionSearch::whyNone() const {
  if (likeliest_ >= kWorthAligning) return "a place that looks like the ROI is aligned in the next image";
  std::ostringstream why;
  why.precision(3);
  why << "no place looks like the ROI: correlation " << likeliest_ << ", expected at least " << kWorthAligning;
  return why.str();
}

std::optional<SearchPlace> RegionSearch::nextSuggested(const cv::Mat& image) {
  while (!suggested_.empty()) {
    SearchPlace place = suggested_.front();
    if (place.by != Suggestion::kConfirmation) {
      const double pixels = start_check_.pixelsTaken(image.size(), place.start.g);
      if (!budget_.payCheap(nominal_cost::kStartChecked + pixels * nominal_cost::kPixelTaken)) return std::nullopt;
      const CheckedStart checked = start_check_.look(image, place.start.g);
      likeliest_ = std::max(likeliest_, checked.correlation);
      if (!(checked.correlation >= kWorthAligning)) {
        suggested_.pop_front();
        continue;
      }
      place.start.g = checked.g;
    }
    const double iteration = iterationCost();
    if (!budget_.pay(lookCost(image.size(), place.start.g) + kUsualWork * iteration)) return std::nullopt;
    place.limits.most_work = kUsualWork + std::max(0.0, budget_.left()) / iteration;
    suggested_.pop_front();
    tried_ = place;
    return place;
  }
  return std::nullopt;
}

// Of an alignment, besides its iterations.
double RegionSearch::lookCost(const cv::Size& image, const Eigen::Matrix3d& g) const {
  const geometry::Quadrilateral corners = geometry::apply(g, keyframes_.roi().corners());
  const double built = std::min(static_cast<double>(image.area()), kAround * geometry::signedArea(corners));
  return built * nominal_cost::kPixelBuilt + finestPixels() * nominal_cost::kPixelLookedAt;
}

// Of the ROI on the finest level.
double RegionSearch::finestPixels() const {
  const geometry::Rectangle& roi = keyframes_.roi();
  const double scale = finestScale(roi);
  return roi.width * roi.height / (scale * scale);
}

// Of an iteration on the finest level.
double RegionSearch::iterationCost() const {
  return finestPixels() * nominal_cost::kPixelIterated;
}

bool RegionSearch::judge(const Attempt& attempt, const RegionAligner& aligner) {
  const EsmResult& esm = attempt.evidence.esm;
  budget_.charge((esm.work - kUsualWork) * iterationCost());  // what it took is known now
  if (esm.status == EsmStatus::kInterrupted && tried_.resumed < kMostResumed) {
    SearchPlace rest = tried_;
    rest.start = esm.state;
    rest.limits.coarsest = esm.level;
    rest.by = tried_.by == Suggestion::kCarried ? Suggestion::kLast : tried_.by;
    ++rest.resumed;
    suggested_.push_front(rest);
  }
  Attempt tried = attempt;
  if (tried.doubt.empty()) tried.doubt = doubtOf(tried, aligner);
  const bool found = tried.doubt.empty();
  if (found || !aligned_ || tried.evidence.zncc > best_.evidence.zncc) {
    best_ = std::move(tried);
    best_by_ = tried_.by;
  }
  aligned_ = true;
  if (found) suggested_.clear();
  return found;
}

// A search tries many places, one of which may pass the usual tests by chance, so its result must pass two more tests.
std::string RegionSearch::doubtOf(const Attempt& found, const RegionAligner& aligner) const {
  const double detail = aligner.detail();
  std::ostringstream why;
  why.precision(3);
  if (found.evidence.esm.status != EsmStatus::kConverged) {
    why << "still moving where it was searched";
  } else if (!(detail >= config_.search.min_detail)) {
    why << "correlation of details " << detail << " where it was searched, expected at least "
        << config_.search.min_detail;
  }
  return why.str();
}

// Does the next piece of the pass, if the budget allows it.
bool RegionSearch::work(const cv::Mat& image, const RegionAligner& aligner) {
  const SearchConfig& search = config_.search;
  if (!passing_) {
    if (began_ || !(search.features || search.correlation)) return false;
    if (!budget_.pay(static_cast<double>(image.total()) * nominal_cost::kPixelTaken)) return false;
    const image::ChannelWeights& weights = aligner.channels().weights[0];
    coarse_ = coarseImage(image, coarseScale(image.size(), search.max_pixels), weights, config_.esm.saturation);
    if (search.features) feature_search_.begin(coarse_, weights, keyframes_);
    to_slide_ = search.correlation;
    began_ = passing_ = true;
  } else if (feature_search_.busy()) {
    if (!budget_.pay(feature_search_.nextCost(keyframes_))) return false;
    feature_search_.work(keyframes_);
    if (feature_search_.busy()) return worked_ = true;
    const std::vector<FeatureCandidate> found = feature_search_.found();
    for (std::size_t k = 0; k < std::min(kCandidates, found.size()); ++k) suggest(found[k].g, Suggestion::kFeatures);
  } else if (to_slide_) {
    if (!budget_.pay(slideCost())) return false;
    slide(aligner);
    to_slide_ = false;
  } else {
    passing_ = false;
  }
  return worked_ = true;
}

double RegionSearch::slideCost() const {
  const double shrink = std::max(1.0, kSlidingScale / coarse_.scale);
  return static_cast<double>(coarse_.grey.total()) / (shrink * shrink) * nominal_cost::kPixelSlidOver;
}

void RegionSearch::slide(const RegionAligner& aligner) {
  if (coarse_.grey.empty()) return;
  const int shrink = std::max(1, static_cast<int>(kSlidingScale) / coarse_.scale);
  const int scale = shrink * coarse_.scale;
  cv::Mat small;
  const cv::Size size(std::max(1, coarse_.grey.cols / shrink), std::max(1, coarse_.grey.rows / shrink));
  cv::resize(coarse_.grey, small, size, 0.0, 0.0, cv::INTER_AREA);
  cv::Mat1f seen;
  small.convertTo(seen, CV_32F);
  int l = 0;
  while (l + 1 < aligner.esm().levels() && aligner.esm().level(l + 1).scale <= scale) ++l;
  const EsmLevel& level = aligner.esm().level(l);
  // Offset of the coarse image's first pixel in the image, or in rectified pixels.
  const double middle = 0.5 * (scale - 1.0);
  Eigen::Matrix3d offset = Eigen::Matrix3d::Identity();
  offset.topRightCorner<2, 1>() << middle, middle;
  if (lens_) {
    const cv::Rect box = image::rectifiedBox(*lens_, coarse_.grey.size() * coarse_.scale);
    offset.topRightCorner<2, 1>() << box.x, box.y;
    Eigen::Matrix3d sampling = offset;
    sampling.topLeftCorner<2, 2>() *= scale;
    cv::Mat1f flat(box.height / scale + 1, box.width / scale + 1);
    cv::Mat1f valid(flat.size());
    const cv::Point origin(cvFloor(middle), cvFloor(middle));
    image::warpBilinear(seen, sampling, *lens_, {origin, static_cast<double>(scale)}, flat, valid);
    flat.setTo(0.0f, valid == 0.0f);
    seen = flat;
  }
  for (const Candidate& candidate :
       templateSearch(level.planes[0].value.view(), level.image_T_patch, seen, scale, aligner.roi(),
                      offset.inverse() * last_.g, static_cast<int>(kCandidates))) {
    suggest(offset * candidate.g, Suggestion::kCorrelation);
  }
}

}  // namespace laparoscope_servo::tracking
