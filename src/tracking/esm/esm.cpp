#include "tracking/esm/esm.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "laparoscope_servo/geometry/sl3.h"
#include "laparoscope_servo/image/warp.h"
#include "laparoscope_servo/robust/scale.h"
#include "tracking/esm/covariance.h"
#include "tracking/esm/normal_equations.h"

namespace laparoscope_servo::tracking {

namespace {

// Steps shrink by about this factor from one to the next before that has been measured.
constexpr double kContraction = 0.3;
constexpr double kSlowest = 0.9;  // steps that shrink by less do not converge
// px of the level, which are 0.2 px of the next finer one and thus below kFar there
constexpr double kCoarseAccuracy = 0.1;
constexpr double kSettled = 0.2;  // standard deviations of the estimate that are still to go: they add 2 % to its error
// Pixels of level 0 that have one error in common, from which on two steps there are enough: a pixel of level 1
// takes in as many (4 x 4 with its smoothing), so level 0 adds no independent information. Noise: 1 to 2; tissue that
// bends: 5 to 30.
constexpr double kCorrelated = 16.0;
// Steps that shrink by this factor or less reach their end soon; others are lengthened, by at most kLongest, where two
// of them have the same direction (their cosine).
constexpr double kSlow = 0.5;
constexpr double kSameWay = 0.9;
constexpr double kLongest = 5.0;
constexpr int kPatience =
    10;                       // iterations on levels that are reached from a coarser one, for the steps to become short
constexpr double kFar = 0.5;  // px of the level, a step after which the region may still be elsewhere
constexpr int kHurry = 2;     // iterations on the first level for the steps to become short, or the region is far
constexpr int kShifts = 4;    // first steps on a coarse level, if far
constexpr double kSameLight = 0.5;  // of the residual's scale, for its mean
constexpr int kTrials = 8;          // iterations with the light of the start, if far

// Squared Mahalanobis distance (8 degrees of freedom) from which the prior is down-weighted, as by Student's t with 8
// degrees of freedom.
constexpr double kFreedom = 8.0;

// Weight of the motion prior for a deviation x from its prediction; 2 for x = 0.
double credibility(const MotionPrior& prior, const geometry::Vector8d& x) {
  return 2.0 * kFreedom / (kFreedom + x.dot(prior.information * x));
}

}  // namespace

void Esm::setReference(const image::RegionPyramid& reference, const geometry::Rectangle& roi) {
  roi_ = roi;
  steps_ = geometry::Sl3Steps(templateFromPixels(roi));
  levels_.clear();
  forgetLight();
  for (int l = 0; l < std::min(config_.levels, reference.levels()); ++l) {
    EsmLevel level(reference, roi, l, lens_.get());
    if (level.planes.empty()) break;
    if (config_.light == Light::kLocal) level.centreLight();
    if (l > 0) matchLightBlocks(level, levels_.back());
    levels_.push_back(std::move(level));
  }
}

void Esm::setWeights(const cv::Mat1f& weights) {
  EsmLevel& finest = levels_[0];
  for (int j = 0; j < finest.height; ++j) std::copy_n(weights.ptr<float>(j), finest.width, finest.weight.row(j));
  for (std::size_t l = 1; l < levels_.size(); ++l) coarsenWeights(levels_[l - 1], scratch_, levels_[l]);
}

void Esm::warp(const image::RegionPyramid& current, EsmLevel& level, int l, const Eigen::Matrix3d& g) {
  const Eigen::Matrix3d level_T_patch = current.levelFromImage(l) * g * level.image_T_patch;
  for (std::size_t c = 0; c < level.planes.size(); ++c) {
    const int channel =
        std::min(static_cast<int>(c), current.channels() - 1);  // an image without colour stands for all
    image::Patch& warped = level.planes[c].warped;
    level.all_valid = lens_ ? image::warpBilinear(current.level(l, channel), g * level.image_T_patch, *lens_,
                                                  {current.origin(), level.scale}, warped, level.valid)
                            : image::warpBilinear(current.level(l, channel), level_T_patch, warped, level.valid);
    warped.extrapolate();
  }
  if (!level.all_valid) level.useValid();
}

void Esm::forgetLight() {
  light_known_ = false;
}

// Starts with the biases of the last image where they are known. Otherwise all blocks have one bias, so that
// differences between blocks still drive the motion.
void Esm::startLight(EsmLevel& level, const EsmState& state) {
  for (EsmPlane& plane : level.planes) {
    if (light_known_ && config_.light == Light::kLocal) {
      plane.bias = plane.before;
      continue;
    }
    for (std::size_t block = 0; block < plane.bias.size(); ++block) {
      plane.bias[block] = state.bias - (1.0 - state.gain) * plane.mean[block];
    }
  }
}

double Esm::rejection(double sigma) const {
  return config_.robust ? robust::kTukey * sigma : 0.0;
}

// Steps that shrink by a factor c, all in one direction, add up to step / (1 - c): Lyusternik's acceleration. Where the
// tissue bends, Gauss-Newton sees more curvature than there is, and c is above 0.9. Lengths and angles by the metric of
// J'WJ. c is not taken from the step after a lengthened one.
Vector10d Esm::accelerated(const Matrix10d& a, const Vector10d& x) {
  const std::optional<Vector10d> before = std::exchange(last_step_, x);
  if (!before) return x;
  const double along = x.dot(a * *before);
  const double length_before = before->dot(a * *before);
  const double contraction = along / length_before;
  if (!(contraction > kSlow) || !(along > kSameWay * std::sqrt(x.dot(a * x) * length_before))) return x;
  last_step_.reset();
  return x * (contraction < 1.0 - 1.0 / kLongest ? 1.0 / (1.0 - contraction) : kLongest);
}

bool Esm::solve(EsmLevel& level, const MotionPrior* prior, bool shift_only, EsmResult& result) {
  Matrix10d a = equations_.matrix();
  Vector10d b = equations_.vector();
  if (prior != nullptr) {
    const double unit = prior->noise * credibility(*prior, deviation_);
    a.topLeftCorner<8, 8>() += unit * prior->information;
    b.head<8>() += unit * (prior->information * deviation_);
  }
  if (extra_ != nullptr) {
    // Both are divided by their own variances, that of the texture being no less than in the images before.
    const double unit = std::max(result.sigma * result.sigma, prior != nullptr ? prior->noise : 0.0);
    askExtra(result.state);
    a += unit * extra_information_;
    b += unit * extra_score_;
  }
  if (shift_only) {
    a.block<6, 10>(2, 0).setZero();
    a.block<10, 6>(0, 2).setZero();
    a.diagonal().segment<6>(2).setOnes();
    b.segment<6>(2).setZero();
  }
  const Factors<10> factors(a);
  if (!(factors.conditioning() > 1e-9)) return false;
  const Vector10d x = -factors.solve(b);
  if (!x.allFinite()) return false;
  const Vector10d step = shift_only ? x : accelerated(a, x);
  deviation_ += step.head<8>();
  const double noise = std::max(result.sigma * result.sigma, prior != nullptr ? prior->noise : 0.0);
  result.last_step_deviations = std::sqrt(x.dot(a * x) / 8.0 / noise);
  EsmState& state = result.state;
  const geometry::Quadrilateral before = geometry::apply(state.g, roi_.corners());
  takeStep(level, step, state);
  const geometry::Quadrilateral after = geometry::apply(state.g, roi_.corners());
  result.last_step = geometry::largestDistance(before, after);
  return state.g.allFinite() && std::isfinite(result.last_step) && state.gain > 0.0;
}

void Esm::takeStep(EsmLevel& level, const Vector10d& x, EsmState& state) {
  state.g = steps_.plus(state.g, x.head<8>());
  state.g /= std::cbrt(state.g.determinant());
  state.gain += x[8];
  state.bias += x[9];
  double bias = 0.0;
  double weight = 0.0;
  auto sums = equations_.blocks().begin();
  for (EsmPlane& plane : level.planes) {
    for (std::size_t block = 0; block < plane.bias.size(); ++block, ++sums) {
      if (config_.light != Light::kLocal) {
        plane.bias[block] = state.bias;
      } else if (light_ == Light::kLocal && sums->weight > 0.0) {
        // The step is one of gain * image + bias; part of it is what the gain's does to the mean.
        plane.bias[block] += x[8] * plane.mean[block] + sums->biasStep(x);
        bias += sums->weight * plane.biasOf(block, state.gain);
        weight += sums->weight;
      }
    }
  }
  if (weight > 0.0) state.bias = bias / weight;
}

void Esm::askExtra(const EsmState& state) {
  extra_information_.setZero();
  extra_score_.setZero();
  if (extra_ != nullptr) extra_->add(state.g, state.gain, extra_information_, extra_score_);
}

void Esm::judge(const MotionPrior* prior, EsmResult& result) {
  Matrix8d known = Matrix8d::Zero();
  if (prior != nullptr) known = credibility(*prior, deviation_) * prior->information;
  if (extra_ != nullptr) {
    askExtra(result.state);
    known += extra_information_.topLeftCorner<8, 8>();
  }
  const EstimateCovariance found = estimateCovariance(equations_.matrix(), equations_.blocks(), result.sigma, known);
  result.noise = found.noise;
  if (!found.covariance) return;
  result.covariance = *found.covariance;
  result.corner_error = cornerError(result.state.g, roi_, result.covariance);
  result.centre_error = centreError(result.state.g, roi_, result.covariance);
}

double Esm::referenceCornerError(double sigma) {
  EsmLevel& level = levels_[0];
  for (EsmPlane& plane : level.planes) {
    for (int j = 0; j < level.height; ++j) std::copy_n(plane.value.row(j), level.width, plane.warped.row(j));
    plane.warped.extrapolate();
  }
  level.all_valid = true;
  equations_.sum(level, roi_, light_, EsmState().gain, rejection(sigma));
  const std::optional<Matrix8d> covariance = covarianceOfNoise(equations_.matrix(), 2.0 * sigma * sigma);
  if (!covariance) return std::numeric_limits<double>::infinity();
  return cornerError(Eigen::Matrix3d::Identity(), roi_, *covariance);
}

EsmStatus Esm::iterate(const image::RegionPyramid& current, int l, const MotionPrior* prior, const Iteration& how,
                       EsmResult& result) {
  EsmLevel& level = levels_[l];
  if (!geometry::isConvex(geometry::apply(result.state.g, roi_.corners()))) return EsmStatus::kOutOfView;
  if (!(allowed_ > 0.0)) return EsmStatus::kInterrupted;
  warp(current, level, l, result.state.g);
  if (how.match_mean) result.state.bias += matchMean(level, result.state.gain);
  light_ = how.light;
  result.sigma = residual_scale_.of(level, result.state.gain);
  equations_.sum(level, roi_, light_, result.state.gain, rejection(result.sigma));
  ++result.iterations;
  const double share = static_cast<double>(level.width * level.height) / (levels_[0].width * levels_[0].height);
  result.work += share;
  allowed_ -= share;
  if (!solve(level, prior, how.shift_only, result)) return EsmStatus::kIllConditioned;
  return EsmStatus::kMaxIterations;
}

// Far from alignment, gain and bias cannot be estimated reliably: a fit to pixels that do not correspond would lower
// the gain, and a bias for each block would absorb the differences that drive the motion. So gain and bias are kept at
// their start values, and the first steps on a coarse level are shifts only. If this does not converge, it is repeated
// with the mean residual set to zero at each step.
EsmStatus Esm::approach(const image::RegionPyramid& current, int l, const MotionPrior* prior, EsmResult& result) {
  EsmLevel& level = levels_[l];
  const EsmState start = result.state;
  const geometry::Vector8d start_deviation = deviation_;
  EsmStatus status = EsmStatus::kMaxIterations;
  for (const bool match : {false, true}) {
    result.state = start;
    deviation_ = start_deviation;
    startLight(level, start);
    const int most = match ? config_.max_iterations : std::min(config_.max_iterations, kTrials);
    for (int k = 0; k < most; ++k) {
      status = iterate(current, l, prior, {Light::kConstant, l > 0 && k < kShifts, match}, result);
      if (status == EsmStatus::kInterrupted) return status;
      if (status != EsmStatus::kMaxIterations) break;
      if (result.last_step > kFar * level.scale) continue;
      // Near, the mean is that of the reference; where it is not, the light has changed.
      if (match) return EsmStatus::kConverged;
      const double missing = matchMean(level, result.state.gain);
      result.state.bias += missing;
      if (std::abs(missing) < kSameLight * result.sigma) return EsmStatus::kConverged;
      break;
    }
  }
  return status;
}

// From the second step on, the ratio of two steps gives the rate of convergence, and with it the distance still to go.
EsmStatus Esm::settle(const image::RegionPyramid& current, int l, int patience, const MotionPrior* prior,
                      EsmResult& result) {
  const double scale = levels_[l].scale;
  const double accuracy = l == 0 ? config_.min_step : std::max(config_.min_step, kCoarseAccuracy * scale);
  double contraction = kContraction;
  last_step_.reset();
  for (int k = 0; k < config_.max_iterations; ++k) {
    const double before = result.last_step;
    const EsmStatus status = iterate(current, l, prior, {config_.light, false, false}, result);
    if (status != EsmStatus::kMaxIterations) return status;
    if (k > 0) contraction = std::min(result.last_step / std::max(before, 1e-9), kSlowest);
    if (result.last_step * contraction / (1.0 - contraction) < accuracy) return EsmStatus::kConverged;
    // The rest of the way is small against the estimate's own uncertainty.
    if (result.last_step_deviations * contraction / (1.0 - contraction) < kSettled) return EsmStatus::kConverged;
    if (k > 0 && l == 0 && result.last_step < kFar * scale && prior != nullptr &&
        prior->noise > kCorrelated * std::pow(result.sigma, 2))
      return EsmStatus::kConverged;
    if (k >= patience && result.last_step > kFar * scale) break;
  }
  return EsmStatus::kMaxIterations;
}

// Where the light is not known, a first iteration with one gain and one bias shows whether the region is far away.
EsmStatus Esm::alignLevel(const image::RegionPyramid& current, int l, bool first, const MotionPrior* prior,
                          EsmResult& result) {
  if (!(light_known_ && config_.light == Light::kLocal)) startLight(levels_[l], result.state);
  const bool may_be_far = first && l + 1 == levels() && config_.light != Light::kConstant;
  if (!may_be_far) return settle(current, l, kPatience, prior, result);
  const EsmResult start = result;
  const geometry::Vector8d start_deviation = deviation_;
  if (!light_known_) {
    const EsmStatus status = iterate(current, l, prior, {Light::kGlobal, false, false}, result);
    if (status != EsmStatus::kMaxIterations) return status;
  }
  if (light_known_ || result.last_step <= kFar * levels_[l].scale) {
    const EsmStatus status = settle(current, l, kHurry, prior, result);
    if (status != EsmStatus::kMaxIterations) return status;
  }
  result.state = start.state;
  deviation_ = start_deviation;
  const EsmStatus status = approach(current, l, prior, result);
  return status == EsmStatus::kConverged ? settle(current, l, config_.max_iterations, prior, result) : status;
}

EsmResult Esm::align(const image::RegionPyramid& current, const EsmState& start, const MotionPrior* prior, int coarsest,
                     int finest, ExtraTerm* extra) {
  EsmResult result;
  extra_ = extra;
  result.state = start;
  result.corner_error = result.centre_error = std::numeric_limits<double>::infinity();
  deviation_.setZero();
  if (prior != nullptr && prior->predicted != start.g) {
    deviation_ = steps_.minus(start.g, prior->predicted);
    if (!deviation_.allFinite()) prior = nullptr;
  }
  const int first = std::min({coarsest, levels() - 1, current.levels() - 1});
  for (int l = first; l >= std::min(finest, first); --l) {
    for (EsmPlane& plane : levels_[l].planes) plane.before = plane.bias;
    const bool newer_above = l + 1 < levels() && levels_[l + 1].aligned > levels_[l].aligned;
    if (newer_above && light_known_ && config_.light == Light::kLocal) inheritLight(levels_[l + 1], levels_[l]);
    levels_[l].aligned = ++alignments_;
    result.level = l;
    result.status = alignLevel(current, l, l == first, prior, result);
    if (result.status != EsmStatus::kConverged && result.status != EsmStatus::kMaxIterations) return result;
    // Still far from converged on a coarse level: the start was too far away, finer levels would not help.
    if (result.status == EsmStatus::kMaxIterations && result.last_step > kFar * levels_[l].scale) return result;
  }
  if (finest > 0 && first > 0) return result;
  light_known_ = true;
  judge(prior, result);
  return result;
}

}  // namespace laparoscope_servo::tracking
