#include "laparoscope_servo/tracking/contour_texture.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <stdexcept>

#include "laparoscope_servo/features/edge_fit.h"
#include "laparoscope_servo/features/spline.h"
#include "laparoscope_servo/image/image_type.h"
#include "laparoscope_servo/image/pyramid.h"
#include "laparoscope_servo/parameters/table.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "laparoscope_servo/validation/error_report.h"
#include "tracking/align/region_aligner.h"
#include "tracking/align/texture.h"
#include "tracking/contour_texture/block_agreement.h"
#include "tracking/contour_texture/edge_term.h"
#include "tracking/esm/esm.h"
#include "tracking/motion_filter.h"

namespace laparoscope_servo::tracking {

namespace {

using features::Reason;

constexpr int kCoarseSites = 64;
constexpr double kFineRange = 6.0;   // px, for the finest level
constexpr double kInset = 2.0;       // px: what lies nearer to the contour is what ESM's smoothing takes from outside
constexpr double kLeastSide = 16.0;  // px, of the contour's box
constexpr int kAround = 17;          // px, over which what is inside is taken to go on beyond the contour
constexpr int kLeastBlocks = 6;      // with texture, to be believed by them alone
constexpr double kAnother = 0.5;     // share of the sites that have to lie on edges for a start by them
constexpr int kOutlinePoints = 100;

bool usable(const EsmResult& estimate) {
  return (estimate.status == EsmStatus::kConverged || estimate.status == EsmStatus::kMaxIterations) &&
         estimate.state.g.allFinite();
}

}  // namespace

void describe(parameters::Table& table, ContourTextureConfig& c) {
  table.flag("texture", c.texture, "the grey levels inside of the contour count");
  table.flag("contour", c.contour, "the edges along it count; one of the two has to");
  table.number("min_block_share", c.min_block_share, {0.1, 1}, "",
               "of the blocks with texture, that correlate with the reference");
  table.number("min_correlation", c.min_correlation, {0.3, 1}, "", "of a block that does");
  table.number("max_corner_error", c.max_corner_error, {0.1, 100}, "px",
               "standard deviation expected of the worst corner of the contour's box");
  table.group("edges", "of the contour", [&] { describe(table, c.edges); });
}

std::vector<std::string> validate(const ContourTextureConfig& config) {
  std::vector<std::string> errors = parameters::errorsOf(config);
  if (!config.texture && !config.contour)
    errors.emplace_back("contour = false beside texture = false, expected one of them true");
  return errors;
}

class ContourTextureTracker::Implementation {
 public:
  explicit Implementation(const ContourTextureConfig& config)
      : config_(config),
        keeper_(config.edges.state),
        esm_(EsmConfig()),
        filter_(config.edges.velocity_damping),
        term_(config.edges) {
    features::summarise(told_, reasonText(Reason::kNothingSelected));
  }

  void select(const cv::Mat& image, double stamp, const features::SelectedFeature& selected);
  void track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion);
  void reset(Reason reason);

  ContourTextureConfig config_;
  features::TrackedFeatures told_;

 private:
  struct Attempt {
    EsmResult esm;
    double share = 0.0;
    Reason reason = Reason::kUndetermined;  // kNone: it may be believed
  };

  void setReference(const cv::Mat& image);
  void weigh(const cv::Mat& image, const cv::Mat1b& inside);
  void build(const cv::Mat& image, const Eigen::Matrix3d& g);
  Attempt attempt(const cv::Mat& image, const EsmState& start, const MotionPrior* prior, bool returning);
  void judge(bool returning, Attempt& attempt);
  void tell(const Attempt& attempt, bool tracking);

  features::StateKeeper keeper_;
  features::Spline contour_;  // in the reference image
  Outline outline_;
  geometry::Rectangle roi_;
  int finest_ = 1;
  Esm esm_;
  image::RegionPyramid pyramid_;
  MotionFilter filter_;
  EdgeTerm term_;
  EsmState last_;  // last estimate that was believed
  cv::Size size_;
  int type_ = 0;
  double stamp_ = 0.0;
  double noise_ = 1.0;  // grey levels, of the finest level
};

void ContourTextureTracker::Implementation::select(const cv::Mat& image, double stamp,
                                                   const features::SelectedFeature& selected) {
  Implementation fresh(config_);
  fresh.contour_ = features::Spline::throughPoints(selected.points, true);
  features::EdgeFit fit(config_.edges);
  const features::EdgeReport report = fit.learn(image, fresh.contour_, selected.range);
  if (report.reason != Reason::kNone && config_.contour) {
    std::ostringstream text;
    text.precision(3);
    text << "no such edge in the image: " << reasonText(report.reason) << " (" << report.used << " of " << report.inside
         << " sites in the image agree, expected half of them)";
    throw std::invalid_argument(text.str());
  }
  if (report.reason != Reason::kNone) fresh.contour_ = features::Spline::throughPoints(selected.points, true);
  fresh.setReference(image);
  fresh.filter_.start(fresh.roi_, fresh.esm_.normalisation(), stamp);
  fresh.keeper_.select(stamp);
  fresh.size_ = image.size();
  fresh.type_ = image.type();
  fresh.stamp_ = stamp;
  features::begin(fresh.told_, {selected});
  fresh.told_.features[0].kind = features::FeatureKind::kHomography;
  *this = std::move(fresh);
  Attempt seen;
  seen.reason = Reason::kNone;
  seen.share = report.share;
  seen.esm.corner_error = esm_.referenceCornerError(noise_);
  tell(seen, true);
}

// The box of the contour is ESM's region, in which only what lies inside of the contour has a weight.
void ContourTextureTracker::Implementation::setReference(const cv::Mat& image) {
  std::vector<cv::Point> polygon;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::max()), high = -low;
  for (int k = 0; k < 4 * contour_.pieces(); ++k) {
    const Eigen::Vector2d p = contour_.at(k / 4.0);
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
    polygon.emplace_back(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  }
  const cv::Rect whole(cv::Point(0, 0), image.size());
  const cv::Rect box =
      cv::Rect(cv::Point(static_cast<int>(std::floor(low.x())), static_cast<int>(std::floor(low.y()))),
               cv::Point(static_cast<int>(std::ceil(high.x())) + 1, static_cast<int>(std::ceil(high.y())) + 1)) &
      whole;
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
  cv::Mat1b inside = cv::Mat1b::zeros(image.size());
  if (config_.texture) cv::fillPoly(inside, std::vector<std::vector<cv::Point>>{polygon}, 255);
  const int inset = static_cast<int>(std::ceil(kInset * finest_));
  cv::erode(inside, inside, cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * inset + 1, 2 * inset + 1}));
  weigh(image(box), inside(box));
  outline_ = Outline(contour_, esm_.normalisation());
  term_.learn(image, outline_);
}

// What is noise and no texture would not drive the motion, but the gain, towards 0.
void ContourTextureTracker::Implementation::weigh(const cv::Mat& image, const cv::Mat1b& inside) {
  cv::Mat grey;
  if (image.channels() == 3) {
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  } else {
    grey = image;
  }
  cv::Mat1f pixels;
  grey.convertTo(pixels, CV_32F);
  const image::LevelNoise left = image::levelNoise(finest_);
  const double noise = noiseOf(pixels);
  noise_ = std::max(1.0, left.deviation * noise);
  const cv::Mat1f plane = esm_.level(0).planes[0].value.view();
  cv::Mat1f weights, mean, share;
  inside.convertTo(weights, CV_32F, 1.0 / 255.0);
  cv::resize(weights, weights, plane.size(), 0, 0, cv::INTER_AREA);
  // Outside of the contour stands what is inside near it, so that the contour itself is no texture.
  cv::Mat1f filled = plane.clone();
  cv::boxFilter(plane.mul(weights), mean, CV_32F, {kAround, kAround}, {-1, -1}, true, cv::BORDER_CONSTANT);
  cv::boxFilter(weights, share, CV_32F, {kAround, kAround}, {-1, -1}, true, cv::BORDER_CONSTANT);
  cv::Mat(mean / (share + 1e-6f)).copyTo(filled, weights < 1.0f);
  esm_.setWeights(weights.mul(textureShare(filled, left.gradient * noise * noise)));
}

// Around the region at `g`, with what the coarsest level needs beyond it.
void ContourTextureTracker::Implementation::build(const cv::Mat& image, const Eigen::Matrix3d& g) {
  const double beyond = std::max(config_.edges.range, 8.0 * (finest_ << EsmConfig().levels) / 2.0);
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
  for (const Eigen::Vector2d& corner : geometry::apply(g, roi_.corners())) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const cv::Rect box(cv::Point(static_cast<int>(low.x() - beyond), static_cast<int>(low.y() - beyond)),
                     cv::Point(static_cast<int>(high.x() + beyond), static_cast<int>(high.y() + beyond)));
  pyramid_.build(image, box, EsmConfig().levels, image::kLuma, finest_);
}

ContourTextureTracker::Implementation::Attempt ContourTextureTracker::Implementation::attempt(const cv::Mat& image,
                                                                                              const EsmState& start,
                                                                                              const MotionPrior* prior,
                                                                                              bool returning) {
  Attempt result;
  const geometry::Quadrilateral corners = geometry::apply(start.g, roi_.corners());
  const cv::Rect whole(cv::Point(0, 0), image.size());
  const Eigen::Vector2d centre = geometry::apply(start.g, roi_.centre());
  if (!geometry::isConvex(corners) || !centre.allFinite() || centre.norm() > 1e5 ||
      !whole.contains(cv::Point(static_cast<int>(centre.x()), static_cast<int>(centre.y())))) {
    result.reason = Reason::kOutside;
    return result;
  }
  build(image, start.g);
  ExtraTerm* edges = config_.contour ? &term_ : nullptr;
  result.esm.state = start;
  if (esm_.levels() > 1) {
    if (config_.contour) term_.look(image, start.g, config_.edges.range, kCoarseSites);
    result.esm = esm_.align(pyramid_, start, prior, esm_.levels() - 1, 1, edges);
    if (!usable(result.esm)) return result;
  }
  if (config_.contour) term_.look(image, result.esm.state.g, kFineRange, config_.edges.max_sites);
  result.esm = esm_.align(pyramid_, result.esm.state, prior, 0, 0, edges);
  if (usable(result.esm)) judge(returning, result);
  return result;
}

// What is seen of either is enough; how well both together fix the region is in the covariance.
void ContourTextureTracker::Implementation::judge(bool returning, Attempt& attempt) {
  const double share = returning ? config_.edges.min_return_share : config_.edges.min_share;
  BlockAgreement blocks;
  if (config_.texture) blocks = blockAgreement(esm_.level(0), noise_, config_.min_correlation);
  const bool by_texture = blocks.correlate >= kLeastBlocks && blocks.share() >= config_.min_block_share;
  attempt.share = blocks.share();
  attempt.reason = Reason::kTooFewSites;
  if (config_.contour) {
    const features::EdgeReport report = term_.judge(attempt.esm.state.g, attempt.esm.covariance, share);
    attempt.reason = report.reason;
    attempt.share = std::max(attempt.share, report.share);
  }
  if (by_texture) attempt.reason = Reason::kNone;
  if (attempt.reason == Reason::kNone && !(attempt.esm.corner_error <= config_.max_corner_error))
    attempt.reason = Reason::kUncertain;
}

void ContourTextureTracker::Implementation::track(const cv::Mat& image, double stamp,
                                                  const std::optional<Eigen::Matrix3d>& motion) {
  if (image.empty()) throw std::invalid_argument("image of 0 x 0 px, expected pixels");
  image::checkType(image);
  if (!std::isfinite(stamp)) throw std::invalid_argument("stamp is not finite, expected seconds");
  if (keeper_.state() == features::State::kIdle) return;
  if (image.size() != size_ || image.type() != type_) return reset(Reason::kImageChanged);
  if (stamp < stamp_) return reset(Reason::kTimeJumpedBack);
  stamp_ = stamp;
  const bool tracking = keeper_.state() == features::State::kTracking;
  std::optional<Eigen::Matrix3d> carried;
  if (motion && motion->allFinite() && motion->determinant() > 1e-12)
    carried = geometry::normaliseDeterminant(*motion * last_.g);
  if (carried && !geometry::isConvex(geometry::apply(*carried, roi_.corners()))) carried.reset();
  const MotionPrior prior = filter_.predict(stamp, carried);
  EsmState start = last_;
  start.g = prior.predicted;
  Attempt best = attempt(image, start, tracking ? &prior : nullptr, !tracking);
  if (best.reason != Reason::kNone && config_.contour) {
    // As far as the edges alone tell.
    term_.look(image, start.g, config_.edges.range, kCoarseSites);
    const features::CoarseResult coarse = term_.coarse(config_.edges.range);
    if (coarse.share >= kAnother) {
      EsmState other = start;
      other.g = geometry::normaliseDeterminant(coarse.motion * start.g);
      esm_.forgetLight();
      best = attempt(image, other, nullptr, !tracking);
    }
  }
  keeper_.step(best.reason, stamp);
  const bool believed = keeper_.state() == features::State::kTracking;
  if (believed) {
    if (tracking) {
      filter_.update(prior, best.esm, stamp, true, carried);
    } else {
      filter_.restart(best.esm, stamp);
    }
    last_ = best.esm.state;
    term_.expectGain(last_.gain);
    if (config_.contour) term_.remember();
  } else {
    filter_.stop();
    esm_.forgetLight();
    if (best.reason == Reason::kNone) last_ = best.esm.state;
  }
  tell(best, believed);
}

void ContourTextureTracker::Implementation::reset(Reason reason) {
  keeper_.reset(reason);
  told_.features.clear();
  features::summarise(told_, reasonText(reason));
}

void ContourTextureTracker::Implementation::tell(const Attempt& attempt, bool tracking) {
  features::TrackedFeature& told = told_.features[0];
  told.state = keeper_.state();
  told.reason = reasonText(keeper_.reason());
  told.share = attempt.share;
  const Eigen::Matrix3d h = last_.g / last_.g(2, 2);
  told.parameters.resize(8);
  told.parameters << h(0, 0), h(0, 1), h(0, 2), h(1, 0), h(1, 1), h(1, 2), h(2, 0), h(2, 1);
  told.outline.resize(kOutlinePoints + 1);
  for (int k = 0; k <= kOutlinePoints; ++k) {
    const int slot = k * (Outline::kSlots / kOutlinePoints) % Outline::kSlots;
    told.outline[static_cast<std::size_t>(k)] = geometry::apply(last_.g, outline_.point(slot));
  }
  if (!tracking) {
    features::setUnknown(told.covariance, 8);
    told.expected_error = std::numeric_limits<double>::infinity();
  } else {
    // H / h22 by x: each column of G A_k, normalised.
    Eigen::Matrix<double, 8, 8> by_step;
    for (int k = 0; k < 8; ++k) {
      geometry::Vector8d unit = geometry::Vector8d::Zero();
      unit[k] = 1.0;
      const Eigen::Matrix3d& n = esm_.normalisation();
      const Eigen::Matrix3d d = last_.g * n.inverse() * geometry::sl3Hat(unit) * n;
      const Eigen::Matrix3d e = (d - h * d(2, 2)) / last_.g(2, 2);
      by_step.col(k) << e(0, 0), e(0, 1), e(0, 2), e(1, 0), e(1, 1), e(1, 2), e(2, 0), e(2, 1);
    }
    told.covariance = by_step * attempt.esm.covariance * by_step.transpose();
    told.expected_error = attempt.esm.corner_error;
  }
  features::summarise(told_, "");
}

ContourTextureTracker::ContourTextureTracker(const ContourTextureConfig& config) {
  validation::throwErrors("contour", validate(config));
  implementation_ = std::make_unique<Implementation>(config);
}
ContourTextureTracker::~ContourTextureTracker() = default;

const features::TrackedFeatures& ContourTextureTracker::select(const cv::Mat& image, double stamp,
                                                               const features::FeatureSelection& selection,
                                                               const features::FeaturePrior&) {
  if (image.empty()) throw std::invalid_argument("image of 0 x 0 px, expected pixels");
  image::checkType(image);
  if (!std::isfinite(stamp)) throw std::invalid_argument("stamp is not finite, expected seconds");
  validation::throwErrors("selection", features::validate(selection, {features::FeatureKind::kSpline}));
  if (selection.size() != 1)
    throw std::invalid_argument("selection: " + std::to_string(selection.size()) + " features, expected 1");
  if (!selection[0].closed)
    throw std::invalid_argument(selection[0].id + ": closed = false, expected true: a contour that has an inside");
  try {
    implementation_->select(image, stamp, selection[0]);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(selection[0].id + ": " + error.what());
  }
  return implementation_->told_;
}

const features::TrackedFeatures& ContourTextureTracker::track(const cv::Mat& image, double stamp,
                                                              const features::FeaturePrior& prior) {
  implementation_->track(image, stamp, prior.motion);
  return implementation_->told_;
}

void ContourTextureTracker::reset() {
  implementation_->reset(Reason::kReset);
}

const features::TrackedFeatures& ContourTextureTracker::features() const {
  return implementation_->told_;
}

}  // namespace laparoscope_servo::tracking
