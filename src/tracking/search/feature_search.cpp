#include "tracking/search/feature_search.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "laparoscope_servo/features/point_matching.h"
#include "laparoscope_servo/geometry/sl3.h"
#include "tracking/search/search_budget.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr double kInlier = 4.0;      // px, of the coarse image
constexpr int kOverlap = 16;         // px of the coarse image, by which strips overlap
constexpr double kStripShare = 0.5;  // share of the budget that a strip may cost

double costOfPoints(double pixels, int count) {
  return pixels * nominal_cost::kPixelDetected + count * nominal_cost::kPointDescribed;
}

// Appends the points of `more` for which `keep` returns a place, at that place.
template <typename Keep>
void append(const features::DescribedPoints& more, const Keep& keep, features::DescribedPoints& all) {
  for (std::size_t k = 0; k < more.points.size(); ++k) {
    const std::optional<cv::Point2f> place = keep(more.points[k]);
    if (!place) continue;
    all.points.push_back(*place);
    all.descriptors.push_back(more.descriptors.row(static_cast<int>(k)));
  }
}

// The k-th of `strips` upright strips of an image.
cv::Rect strip(const cv::Size& size, int k, int strips) {
  const int first = size.width * k / strips;
  return {first, 0, size.width * (k + 1) / strips - first, size.height};
}

// Appends the points of a part of the image where `usable` is not 0, see append(); `keep` gets points of the image.
template <typename Keep>
void drawPointsOf(const cv::Mat1b& image, const cv::Mat1b& usable, const cv::Rect& own, int count, const Keep& keep,
                  features::DescribedPoints& all) {
  const cv::Rect seen =
      cv::Rect(own.x - kOverlap, own.y, own.width + 2 * kOverlap, own.height) & cv::Rect(cv::Point(0, 0), image.size());
  cv::Mat1b wanted = cv::Mat1b::zeros(seen.size());
  usable(own).copyTo(wanted(own - seen.tl()));
  append(
      features::drawPoints(image(seen), wanted, count),
      [&](const cv::Point2f& p) { return keep(p + cv::Point2f(seen.tl())); }, all);
}

// Takes a raw point to a rectified one; empty if the lens cannot show such a point.
std::optional<cv::Point2f> rectified(const image::Lens* lens, const cv::Point2f& point) {
  if (lens == nullptr) return point;
  const auto p = lens->toRectified(Eigen::Vector2d(point.x, point.y));
  if (!p) return std::nullopt;
  return cv::Point2f(static_cast<float>(p->x()), static_cast<float>(p->y()));
}

}  // namespace

FeatureSearch::FeatureSearch(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens)
    : config_(config.search),
      saturation_(config.esm.saturation),
      max_area_ratio_(config.quality.max_area_ratio),
      lens_(std::move(lens)) {}

void FeatureSearch::retune(const TrackerConfig& config) {
  config_ = config.search;
  max_area_ratio_ = config.quality.max_area_ratio;
}

void FeatureSearch::restart() {
  turn_ = 0;
  strip_ = strips_ = 0;
  asked_.clear();
  view_.reset();
}

void FeatureSearch::begin(const CoarseImage& image, const image::ChannelWeights& weights, const Keyframes& keyframes) {
  found_.clear();
  seen_ = features::DescribedPoints();
  weights_ = weights;
  asked_.clear();
  view_.reset();
  strip_ = strips_ = 0;
  coarse_ = image;
  if (keyframes.count() == 0 || coarse_.grey.empty()) return;
  const double cost = costOfPoints(static_cast<double>(coarse_.grey.total()), config_.max_features);
  strips_ = stripsOf(coarse_.grey.size(), cost, kStripShare * config_.budget);
  const int others = keyframes.count() - 1 - (keyframes.hasRecent() ? 1 : 0);
  if (others > 0) asked_.push_back(1 + turn_++ % others);
  if (keyframes.hasRecent()) asked_.push_back(keyframes.count() - 1);
  asked_.push_back(0);
}

// How many strips make each cost `most_cost` at most, as far as they are clearly wider than their overlap.
int FeatureSearch::stripsOf(const cv::Size& size, double cost, double most_cost) const {
  return std::clamp(static_cast<int>(std::ceil(cost / most_cost)), 1, std::max(1, size.width / (4 * kOverlap)));
}

int FeatureSearch::stripsOf(const Keyframe& keyframe) const {
  const cv::Size size = coarseSize(keyframe);
  return stripsOf(size, costOfPoints(size.area(), config_.max_features / 2), kStripShare * config_.budget);
}

double FeatureSearch::nextCost(const Keyframes& keyframes) const {
  if (strip_ < strips_) {
    const cv::Rect part = strip(coarse_.grey.size(), strip_, strips_);
    return costOfPoints((part.width + 2.0 * kOverlap) * part.height, config_.max_features / strips_);
  }
  const Keyframe& keyframe = keyframes.at(asked_.back());
  if (!keyframe.described && !view_)
    return static_cast<double>(keyframe.crop.total()) * (nominal_cost::kPixelTaken + nominal_cost::kPixelMasked);
  if (!keyframe.described) {
    const int strips = stripsOf(keyframe);
    const cv::Size size = coarseSize(keyframe);
    const double overlap = strips > 1 ? 2.0 * kOverlap * size.height : 0.0;
    return costOfPoints(size.area() / strips + overlap, config_.max_features / 2 / strips);
  }
  const double pairs = static_cast<double>(keyframe.features.points.size()) * static_cast<double>(seen_.points.size());
  return pairs * nominal_cost::kPairCompared + nominal_cost::kMotionFitted;
}

void FeatureSearch::work(Keyframes& keyframes) {
  if (strip_ < strips_) return drawStrip();
  Keyframe& keyframe = keyframes.at(asked_.back());
  if (!keyframe.described) return view_ ? describe(keyframe) : takeView(keyframe, keyframes.roi());
  asked_.pop_back();
  match(keyframe, keyframes.roi());
}

// Each strip gets its share of the points, so that an instrument does not take all of them.
void FeatureSearch::drawStrip() {
  const cv::Rect own = strip(coarse_.grey.size(), strip_++, strips_);
  if (own.empty()) return;
  drawPointsOf(
      coarse_.grey, coarse_.usable, own, config_.max_features / strips_,
      [&](const cv::Point2f& p) { return rectified(lens_.get(), coarse_.inImage(p)); }, seen_);
  if (strip_ == strips_ && static_cast<int>(seen_.points.size()) < config_.min_inliers) asked_.clear();
}

// Uses the whole crop except the covered parts of the ROI: the tissue around the ROI moves with it, and small or smooth
// regions are found by their surroundings.
void FeatureSearch::takeView(const Keyframe& keyframe, const geometry::Rectangle& roi) {
  Eigen::Matrix3d from_mask = Eigen::Matrix3d::Identity();
  from_mask.diagonal().head<2>() << roi.width / keyframe.trusted.cols, roi.height / keyframe.trusted.rows;
  from_mask.topRightCorner<2, 1>() << roi.x, roi.y;
  cv::Mat1b covered;
  image::drawMask(keyframe.trusted == 0, keyframe.g * from_mask, lens_.get(),
                  cv::Rect(keyframe.first, keyframe.crop.size()), covered);
  view_ = coarseImage(keyframe.crop, coarse_.scale, weights_, saturation_);
  if (view_->grey.empty()) return;
  cv::Mat1b mask;
  cv::resize(covered, mask, view_->grey.size(), 0.0, 0.0, cv::INTER_NEAREST);
  view_->usable.setTo(0, mask);
}

void FeatureSearch::describe(Keyframe& keyframe) {
  const CoarseImage small = *view_;
  const int strips = stripsOf(keyframe);
  // Fewer strips than before when the budget was raised in between: nothing is left then.
  const cv::Rect own =
      strip(small.grey.size(), keyframe.strips_described++, strips) & cv::Rect(cv::Point(0, 0), small.grey.size());
  keyframe.described = keyframe.strips_described >= strips;
  if (keyframe.described) view_.reset();
  if (own.empty()) return;
  const cv::Point2f first(keyframe.first);
  drawPointsOf(
      small.grey, small.usable, own, config_.max_features / 2 / strips,
      [&](const cv::Point2f& p) { return rectified(lens_.get(), small.inImage(p) + first); }, keyframe.features);
}

std::vector<FeatureCandidate> FeatureSearch::found() const {
  std::vector<FeatureCandidate> best = found_;
  std::stable_sort(best.begin(), best.end(), [](const auto& a, const auto& b) { return a.inliers > b.inliers; });
  return best;
}

std::vector<FeatureCandidate> FeatureSearch::find(const cv::Mat& image, const image::ChannelWeights& weights,
                                                  Keyframes& keyframes) {
  const int scale = coarseScale(image.size(), config_.max_pixels);
  begin(coarseImage(image, scale, weights, saturation_), weights, keyframes);
  while (busy()) work(keyframes);
  return found();
}

void FeatureSearch::match(const Keyframe& keyframe, const geometry::Rectangle& roi) {
  if (static_cast<int>(keyframe.features.points.size()) < config_.min_inliers) return;
  std::vector<cv::Point2f> from, to;
  for (const auto& [known, seen] : features::matchPoints(keyframe.features, seen_, config_.max_ratio)) {
    from.push_back(keyframe.features.points[static_cast<std::size_t>(known)]);
    to.push_back(seen_.points[static_cast<std::size_t>(seen)]);
  }
  // Of few matches a similarity only; the alignment corrects the tilt.
  for (const features::AgreedMotion& agreed :
       features::agreedMotions(from, to, kInlier * coarse_.scale, config_.min_inliers)) {
    const Eigen::Matrix3d g = agreed.motion * keyframe.g;
    if (plausible(g, roi)) found_.push_back({geometry::normaliseDeterminant(g), agreed.inliers});
  }
}

bool FeatureSearch::plausible(const Eigen::Matrix3d& g, const geometry::Rectangle& roi) const {
  if (!g.allFinite() || !(g.determinant() > 0.0)) return false;
  const geometry::Quadrilateral corners = geometry::apply(g, roi.corners());
  if (!geometry::isConvex(corners)) return false;
  const double ratio = geometry::signedArea(corners) / geometry::signedArea(roi.corners());
  return std::max(ratio, 1.0 / ratio) <= max_area_ratio_;
}

}  // namespace laparoscope_servo::tracking
