#include "tracking/contour_texture/contour_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "laparoscope_servo/tracking/tracker_config.h"
#include "tracking/align/region_aligner.h"
#include "tracking/contour_texture/texture_weights.h"

namespace laparoscope_servo::tracking {

namespace {

using features::Reason;

constexpr int kCoarseSites = 64;
constexpr double kFineRange = 6.0;   // px, for the finest level
constexpr double kLeastSide = 16.0;  // px, of the contour's box
constexpr int kLeastBlocks = 6;      // with texture, to be believed by them alone
// Share of the edges that has to agree where most blocks of texture do not correlate: with 0.3, edges of what covers
// both halves were believed for two images of one sequence of eight (bench_contour).
constexpr double kAgainstTexture = 0.5;
constexpr double kAnother = 0.5;    // share of the sites that have to lie on edges for a start by them
constexpr double kManyFresh = 0.1;  // of the blocks that are shown: so many newly covered ones make another fit
constexpr int kRounds = 2;          // alignments on the finest level, as what is covered is found out

bool usable(const EsmResult& estimate) {
  return (estimate.status == EsmStatus::kConverged || estimate.status == EsmStatus::kMaxIterations) &&
         estimate.state.g.allFinite();
}

cv::Rect boxOf(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::max()), high = -low;
  for (const Eigen::Vector2d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {cv::Point(static_cast<int>(std::floor(low.x())), static_cast<int>(std::floor(low.y()))),
          cv::Point(static_cast<int>(std::ceil(high.x())) + 1, static_cast<int>(std::ceil(high.y())) + 1)};
}

}  // namespace

ContourFit::ContourFit(const ContourTextureConfig& config)
    : config_(config), esm_(EsmConfig()), edges_(config.edges), edges_count_(config.contour) {}

// The box of the contour is ESM's region, in which only what lies inside of the contour has a weight.
void ContourFit::setReference(const cv::Mat& image, const features::Spline& contour) {
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k < 4 * contour.pieces(); ++k) points.push_back(contour.at(k / 4.0));
  const cv::Rect box = boxOf(points) & cv::Rect(cv::Point(0, 0), image.size());
  if (!(box.width >= kLeastSide && box.height >= kLeastSide)) {
    std::ostringstream text;
    text << "the contour takes " << box.width << " x " << box.height << " px of the image, expected at least "
         << kLeastSide << " px in width and height";
    throw std::invalid_argument(text.str());
  }
  roi_ = {static_cast<double>(box.x), static_cast<double>(box.y), static_cast<double>(box.width),
          static_cast<double>(box.height)};
  finest_ = finestScale(roi_);
  build(image, Eigen::Matrix3d::Identity());
  esm_.setReference(pyramid_, roi_);
  const cv::Mat1b inside = config_.texture ? insideOf(points, box, finest_) : cv::Mat1b::zeros(box.size());
  TextureWeights texture = textureWeights(image(box), inside, esm_.level(0).planes[0].value.view(), finest_);
  noise_ = texture.noise;
  blocks_.setReference(esm_.level(0), texture.weights, noise_);
  esm_.setWeights(texture.weights);
  outline_ = Outline(contour, esm_.normalisation());
  edges_.learn(image, outline_);
}

// Around the region at `g`, with what the coarsest level needs beyond it.
void ContourFit::build(const cv::Mat& image, const Eigen::Matrix3d& g) {
  const int beyond = static_cast<int>(std::max(config_.edges.range, 4.0 * (finest_ << EsmConfig().levels)));
  const geometry::Quadrilateral corners = geometry::apply(g, roi_.corners());
  Eigen::Vector2d low = corners[0], high = corners[0];
  for (const Eigen::Vector2d& corner : corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const cv::Rect box(cv::Point(static_cast<int>(low.x()) - beyond, static_cast<int>(low.y()) - beyond),
                     cv::Point(static_cast<int>(high.x()) + beyond, static_cast<int>(high.y()) + beyond));
  pyramid_.build(image, box, EsmConfig().levels, image::kLuma, finest_);
}

bool ContourFit::isInView(const cv::Mat& image, const Eigen::Matrix3d& g) const {
  const Eigen::Vector2d centre = geometry::apply(g, roi_.centre());
  return geometry::isConvex(geometry::apply(g, roi_.corners())) && centre.x() >= 0.0 && centre.y() >= 0.0 &&
         centre.x() < image.cols && centre.y() < image.rows;
}

ContourEstimate ContourFit::align(const cv::Mat& image, const EsmState& start, const MotionPrior* prior,
                                  double min_share) {
  ContourEstimate result;
  result.esm.state = start;
  if (!isInView(image, start.g)) {
    result.reason = Reason::kOutside;
    return result;
  }
  build(image, start.g);
  ExtraTerm* edges = edges_count_ ? &edges_ : nullptr;
  if (esm_.levels() > 1) {
    if (edges != nullptr) edges_.look(image, start.g, config_.edges.range, kCoarseSites);
    result.esm = esm_.align(pyramid_, start, prior, esm_.levels() - 1, 1, edges);
    if (!usable(result.esm)) return result;
  }
  if (config_.contour)
    edges_.look(image, result.esm.state.g, kFineRange, edges != nullptr ? config_.edges.max_sites : kCoarseSites);
  for (int round = 0; round < kRounds; ++round) {
    result.esm = esm_.align(pyramid_, result.esm.state, prior, 0, 0, edges);
    if (!usable(result.esm)) return result;
    bool changed = false;
    if (config_.texture) {
      changed = blocks_.look(esm_.level(0), config_.min_correlation) > kManyFresh * blocks_.correlated();
      if (blocks_.changed()) esm_.setWeights(blocks_.weights());
    }
    if (config_.contour) changed = (edges_.gate(result.esm.state.g) && edges != nullptr) || changed;
    judge(min_share, result);
    changed = changed || edges_count_ != (edges != nullptr);
    if (!changed) break;
    edges = edges_count_ ? &edges_ : nullptr;
  }
  return result;
}

// What is seen of either is enough, unless the texture contradicts the edges; how well both together fix the region is
// in the covariance. Edges that agree no more than by chance, while the texture tells where it is, would only pull.
void ContourFit::judge(double min_share, ContourEstimate& estimate) {
  const bool by_texture =
      config_.texture && blocks_.correlated() >= kLeastBlocks && blocks_.share() >= config_.min_block_share;
  estimate.share = config_.texture ? blocks_.share() : 0.0;
  estimate.reason = Reason::kTooFewSites;
  if (config_.contour) {
    const bool contradicted = config_.texture && blocks_.textured() >= kLeastBlocks && !by_texture;
    const double least = contradicted ? std::max(min_share, kAgainstTexture) : min_share;
    const features::EdgeReport report = edges_.judge(estimate.esm.covariance, least);
    estimate.reason = report.reason;
    estimate.share = std::max(estimate.share, report.share);
    edges_agree_ = report.reason == Reason::kNone || report.reason == Reason::kUncertain;
    edges_count_ = edges_agree_ || !by_texture;
  }
  if (by_texture) estimate.reason = Reason::kNone;
  if (estimate.reason == Reason::kNone && !(estimate.esm.corner_error <= config_.max_corner_error))
    estimate.reason = Reason::kUncertain;
}

std::optional<Eigen::Matrix3d> ContourFit::elsewhere(const cv::Mat& image, const Eigen::Matrix3d& g) {
  if (!config_.contour) return std::nullopt;
  edges_.look(image, g, config_.edges.range, kCoarseSites);
  const features::CoarseResult coarse = edges_.coarse(config_.edges.range);
  if (!(coarse.share >= kAnother)) return std::nullopt;
  return geometry::normaliseDeterminant(coarse.motion * g);
}

void ContourFit::remember(const EsmState& state) {
  edges_.expectGain(state.gain);
  if (edges_agree_) edges_.remember();
}

void ContourFit::forget() {
  edges_count_ = config_.contour;
  esm_.forgetLight();
  blocks_.forget();
  edges_.forget();
  esm_.setWeights(blocks_.weights());
}

}  // namespace laparoscope_servo::tracking
