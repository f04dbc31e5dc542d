#include "motion/motion_aligner.h"

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/image/warp.h"
#include "laparoscope_servo/robust/scale.h"
#include "motion/float_median.h"
#include "motion/square_weights.h"

namespace laparoscope_servo::motion {

namespace {

using tracking::EsmLevel;
using tracking::Matrix10d;
using tracking::Vector10d;

constexpr int kCoarseIterations = 8;
constexpr int kShifts = 2;               // of these, the first so many change the shift alone
constexpr int kIterations = 6;           // at most, on each further level
constexpr double kContraction = 0.2;     // ratio of a step to the one before, until it is measured
constexpr double kSlowest = 0.9;         // largest ratio that is extrapolated
constexpr double kCoarseAccuracy = 0.1;  // px of the level
constexpr double kAccuracy = 0.01;       // px of the finest level
constexpr double kApart = 0.5;           // px of the coarsest level: starts nearer to each other are one
constexpr double kBetter = 0.98;         // another start needs a cost below this share of that of the expected motion
constexpr double kFarther = 0.1;         // px of the level: an expected motion nearer to the one found is the same
constexpr int kTrims = 3;                // rounds in which the scale is computed anew without outliers
constexpr int kMostJudged = 100000;      // px of a level: on one of 320 x 240 two motions that differ can be told apart
constexpr double kAsExpected = 1.15;     // times the expected scale: larger residuals may be of a wrong motion
constexpr double kMayGrow = 1.3;         // times the expected scale: the bound of the scale
constexpr double kLeastBound = 2.5;      // grey levels: a scale up to this is never bounded
constexpr double kSingular = 1e-9;
// px of the finest level: error of bilinear sampling where the whole image is shifted by a part of a pixel, without any
// noise: bench_motion, constant motion, has 0.011 of an image of 640 x 480, 0.017 of a halved one.
constexpr double kInterpolation = 0.015;
// Px of the finest level along a column and a row, from one difference of which a block's offset is begun to the next,
// and how few are too few: a block of an image of 640 x 480 has some 260.
constexpr int kOffsetRows = 2, kOffsetColumns = 4;
constexpr std::size_t kFewestDifferences = 16;
constexpr double kDark = 0.5, kBright = 2.0;  // bounds of the gain between two images

// Fixes the unknowns that are not estimated at 0, by a row of the identity.
void restrictTo(Matrix10d& a, Vector10d& b, int motion, bool gain, bool offset) {
  const auto fix = [&](int k) {
    a.row(k).setZero();
    a.col(k).setZero();
    a(k, k) = 1.0;
    b[k] = 0.0;
  };
  for (int k = motion; k < 8; ++k) fix(k);
  if (!gain) fix(8);
  if (!offset) fix(9);
}

tracking::Light lightOf(const MotionConfig& config) {
  return config.light ? tracking::Light::kGlobal : tracking::Light::kConstant;
}

}  // namespace

void MotionAligner::setReference(const MotionImage& image) {
  shading_.forget();
  const cv::Size size = image.pyramid.region().size();
  const bool known = static_cast<int>(levels_.size()) == image.pyramid.levels() && frame_.width == size.width &&
                     frame_.height == size.height;
  if (known) {
    for (int l = 0; l < levels(); ++l) levels_[static_cast<std::size_t>(l)].take(image.pyramid, l);
    return;
  }
  frame_ = {0.0, 0.0, static_cast<double>(size.width), static_cast<double>(size.height)};
  steps_ = geometry::Sl3Steps(tracking::templateFromPixels(frame_));
  levels_.clear();
  for (int l = 0; l < image.pyramid.levels(); ++l) levels_.emplace_back(image.pyramid, frame_, l);
  const EsmLevel& finest = levels_[0];
  differences_.reserve(
      static_cast<std::size_t>((finest.height / kOffsetRows + 1) * (finest.width / kOffsetColumns + 1)));
  all_usable_ = false;
}

JointUse MotionAligner::setUsable(const MotionImage& reference, const MotionImage& current, const Eigen::Matrix3d& g,
                                  const geometry::Quadrilateral* region) {
  const JointUse use = jointlyUsable(reference.usable, current.usable, g, region, joint_);
  const bool all = reference.usable.all() && current.usable.all() && region == nullptr;
  if (all && all_usable_) return use;
  for (EsmLevel& level : levels_) setWeights(joint_, reference.usable.side(), level);
  all_usable_ = all;
  return use;
}

void MotionAligner::warpImage(const MotionImage& current, int l, const Eigen::Matrix3d& g) {
  EsmLevel& level = levels_[static_cast<std::size_t>(l)];
  tracking::EsmPlane& plane = level.planes[0];
  level.all_valid = image::warpBilinear(
      current.pyramid.level(l), current.pyramid.levelFromImage(l) * g * level.image_T_patch, plane.warped, level.valid);
  if (shaded_) shading_.correct(level);
  plane.warped.extrapolate();
  if (!level.all_valid) level.useValid();
}

void MotionAligner::fitShading(const MotionImage& current, int l, const Eigen::Matrix3d& g) {
  shading_.forget();
  warpImage(current, l, g);
  shading_.fit(levels_[static_cast<std::size_t>(l)]);
}

void MotionAligner::setOffset(int l, double offset) {
  std::vector<double>& bias = levels_[static_cast<std::size_t>(l)].planes[0].bias;
  std::fill(bias.begin(), bias.end(), offset);
}

void MotionAligner::warp(const MotionImage& current, int l, const Alignment& at) {
  warpImage(current, l, at.g);
  if (!hasOwnOffsets(l)) setOffset(l, at.offset);
}

// The median of each block's differences: after one offset for all, Tukey's weights would drop whole blocks that are
// brighter or darker than that. A block that shows too little has the offset of all.
void MotionAligner::beginOffsets(int l, const Alignment& at) {
  setOffset(l, at.offset);
  EsmLevel& level = levels_[static_cast<std::size_t>(l)];
  tracking::EsmPlane& plane = level.planes[0];
  const image::Patch& weight = level.usedWeight();
  const float gain = static_cast<float>(at.gain);
  const std::vector<int>& columns = level.light_column_of_strip;
  std::size_t block = 0;
  for (std::size_t row = 0; row + 1 < level.light_row_begin.size(); ++row) {
    for (std::size_t strip = 0; strip < columns.size(); ++block) {
      const int begin = static_cast<int>(strip) * image::Patch::kStrip;
      const int column = columns[strip];
      while (strip < columns.size() && columns[strip] == column) ++strip;
      const int end = std::min(level.width, static_cast<int>(strip) * image::Patch::kStrip);
      differences_.clear();
      for (int j = level.light_row_begin[row]; j < level.light_row_begin[row + 1]; j += kOffsetRows) {
        for (int i = begin; i < end; i += kOffsetColumns) {
          if (weight(j, i) > 0.0f) differences_.push_back(plane.value(j, i) - gain * plane.warped(j, i));
        }
      }
      if (differences_.size() >= kFewestDifferences) plane.bias[block] = static_cast<double>(floatMedian(differences_));
    }
  }
}

void MotionAligner::stepOffsets(int l, const Vector10d& x, Alignment& at) {
  std::vector<double>& bias = levels_[static_cast<std::size_t>(l)].planes[0].bias;
  double sum = 0.0, weight = 0.0;
  for (std::size_t k = 0; k < bias.size(); ++k) {
    const tracking::LightBlockSums& block = equations_.blocks()[k];
    if (!(block.weight > 0.0)) continue;
    bias[k] += block.biasStep(x);
    sum += block.weight * bias[k];
    weight += block.weight;
  }
  if (weight > 0.0) at.offset = sum / weight;
}

// The robust scale of all residuals, then of those within its bound, and so on; bounded by the expected scale.
double MotionAligner::scaleOf(int l, const tracking::ResidualScale& scale, double found) const {
  for (int k = 0; k < kTrims; ++k) found = scale.ofKept(found);
  const double expected = expected_[static_cast<std::size_t>(l)];
  return expected > 0.0 ? std::min(found, std::max(kLeastBound, kMayGrow * expected)) : found;
}

bool MotionAligner::step(const MotionImage& current, int l, const Unknowns& unknowns, Offsets offsets,
                         tracking::ResidualScale& scale, Alignment& at, bool warped) {
  if (!warped) warpImage(current, l, at.g);
  const bool local = offsets != Offsets::kOne;
  if (offsets == Offsets::kOne) setOffset(l, at.offset);
  if (offsets == Offsets::kBegin) beginOffsets(l, at);
  const EsmLevel& level = levels_[static_cast<std::size_t>(l)];
  at.sigma = scaleOf(l, scale, scale.of(level, at.gain));
  equations_.sum(level, frame_, local ? tracking::Light::kLocal : lightOf(config_), at.gain, robust::kTukey * at.sigma);
  ++at.iterations;
  Matrix10d a = equations_.matrix();
  Vector10d b = equations_.vector();
  restrictTo(a, b, unknowns.motion, unknowns.gain, unknowns.offset);
  const tracking::Factors<10> factors(a);
  at.determined = factors.conditioning() > kSingular;
  if (!at.determined) return false;
  const Vector10d x = -factors.solve(b);
  const Eigen::Matrix3d before = at.g;
  at.g = steps_.plus(at.g, x.head<8>());
  at.g /= std::cbrt(at.g.determinant());
  at.gain = std::clamp(at.gain + x[8], kDark, kBright);
  if (local) {
    stepOffsets(l, x, at);
  } else {
    at.offset += x[9];
  }
  at.last_step = geometry::cornerDistance(before, at.g, frame_);
  at.determined = at.g.allFinite() && std::isfinite(at.last_step);
  return at.determined;
}

// Mean cost of a pixel, 0 to 1. Pixels beyond the image count as outliers. `most`: the largest number of residuals in
// the image that a start has.
double MotionAligner::costOf(std::size_t start, double sigma, int most) const {
  const tracking::ResidualScale& residuals = residuals_[start];
  return 1.0 - residuals.count() * (1.0 - residuals.cost(sigma)) / std::max(1, most);
}

// Takes a few steps from each start on the coarsest level, and returns the result with the least cost; all costs are
// computed with one scale. The gain is not estimated yet: while pixels do not correspond it would come out too small.
Alignment MotionAligner::bestStart(const MotionImage& current, const std::vector<Eigen::Matrix3d>& starts) {
  const int l = levels() - 1;
  const EsmLevel& level = levels_[static_cast<std::size_t>(l)];
  std::array<Alignment, kMostStarts> found;
  std::array<Eigen::Matrix3d, kMostStarts> begun;
  int count = 0;
  double sigma = std::numeric_limits<double>::infinity();
  const auto start = [&](const Eigen::Matrix3d& g) {
    if (count == kMostStarts) return;
    for (int k = 0; k < count; ++k) {
      if (geometry::cornerDistance(begun[static_cast<std::size_t>(k)], g, frame_) < kApart * level.scale) return;
    }
    begun[static_cast<std::size_t>(count)] = g;
    Alignment& at = found[static_cast<std::size_t>(count)];
    tracking::ResidualScale& residuals = residuals_[static_cast<std::size_t>(count)];
    at.g = g;
    for (int k = 0; k < kCoarseIterations; ++k) {
      const int motion = k < kShifts ? parametersOf(Model::kConstant) : parametersOf(config_.model);
      if (!step(current, l, {motion, false, config_.light}, Offsets::kOne, residuals, at)) break;
      if (k >= kShifts && at.last_step < kCoarseAccuracy * level.scale) break;
    }
    if (!at.determined) return;
    sigma = std::min(sigma, at.sigma);
    ++count;
  };
  for (const Eigen::Matrix3d& g : starts) start(g);
  Eigen::Matrix3d voted = Eigen::Matrix3d::Identity();
  voted.topRightCorner<2, 1>() = level.scale * votes_.find(level, current.pyramid.level(l));
  start(voted);
  if (count == 0) return {};
  int most = 0;
  for (int k = 0; k < count; ++k) most = std::max(most, residuals_[static_cast<std::size_t>(k)].count());
  int best = 0;
  for (int k = 1; k < count; ++k) {
    if (costOf(static_cast<std::size_t>(k), sigma, most) <
        (best == 0 ? kBetter : 1.0) * costOf(static_cast<std::size_t>(best), sigma, most))
      best = k;
  }
  scales_[static_cast<std::size_t>(l)] = found[static_cast<std::size_t>(best)].sigma;
  return found[static_cast<std::size_t>(best)];
}

// Two motions that are near each other look alike on coarse levels, and a fit to all pixels ends between them. So where
// residuals are larger than expected, four motions compete: the one that was found, the expected one, and each of them
// corrected by the votes of the cells. Returns whether the level's image is warped by the motion that was chosen.
bool MotionAligner::judgeAgain(const MotionImage& current, int l, const Eigen::Matrix3d& predicted, Alignment& at) {
  const EsmLevel& level = levels_[static_cast<std::size_t>(l)];
  const double expected = expected_[static_cast<std::size_t>(l)];
  const Eigen::Matrix<double, 8, 8> t = fieldFromSl3(tracking::halfSize(frame_));
  std::array<Eigen::Matrix3d, kMostStarts> candidates;
  std::size_t count = 0;
  double least = std::numeric_limits<double>::infinity();
  int most = 0;
  const auto look = [&](const Eigen::Matrix3d& g) {
    warpImage(current, l, g);
    setOffset(l, at.offset);
    tracking::ResidualScale& residuals = residuals_[count];
    const double sigma = scaleOf(l, residuals, residuals.of(level, at.gain));
    least = std::min(least, sigma);
    most = std::max(most, residuals.count());
    candidates[count++] = g;
    return sigma;
  };
  for (const Eigen::Matrix3d& base : {at.g, predicted}) {
    if (count > 0 && geometry::cornerDistance(base, at.g, frame_) < kFarther * level.scale) break;
    const double sigma = look(base);
    if (expected > 0.0 && sigma < kAsExpected * expected) {
      at.g = base;
      return true;
    }
    equations_.sum(level, frame_, lightOf(config_), at.gain, 0.0);
    const double noise = std::min(sigma, std::max(kLeastBound, expected));
    const auto left = cell_votes_.fit(level, equations_.cells(), noise, config_.model);
    if (left) look(steps_.plus(base, t.inverse() * *left));
  }
  std::size_t best = 0;
  for (std::size_t k = 1; k < count; ++k) {
    if (costOf(k, least, most) < costOf(best, least, most)) best = k;
  }
  at.g = candidates[best];
  return best + 1 == count;
}

// Iterates until the remaining way, extrapolated from how the steps shrink, is short. `warped`: the level's image is
// warped by the motion from which it begins.
void MotionAligner::refine(const MotionImage& current, int l, bool warped, Alignment& at) {
  const double scale = levels_[static_cast<std::size_t>(l)].scale;
  const bool local = hasOwnOffsets(l);
  const double accuracy = scale * (l == 0 ? kAccuracy : kCoarseAccuracy);
  double contraction = kContraction;
  for (int k = 0; k < kIterations; ++k) {
    const double before = at.last_step;
    const Offsets offsets = !local ? Offsets::kOne : k == 0 ? Offsets::kBegin : Offsets::kGoOn;
    if (!step(current, l, all(), offsets, residuals_[0], at, warped && k == 0)) return;
    if (k > 0) contraction = std::min(at.last_step / std::max(before, 1e-9), kSlowest);
    if (at.last_step * contraction / (1.0 - contraction) < accuracy) break;
  }
  scales_[static_cast<std::size_t>(l)] = at.sigma;
}

Alignment MotionAligner::align(const MotionImage& current, const std::vector<Eigen::Matrix3d>& starts,
                               const Scales& expected) {
  expected_ = expected;
  scales_.fill(0.0);
  Alignment at = bestStart(current, starts);
  for (int l = levels() - (levels() > 1 ? 2 : 1); l >= 0 && at.determined; --l) {
    // The finest level would tell no more than the one before.
    if (shaded_ && (l > 0 || levels() == 1)) fitShading(current, l, at.g);
    const EsmLevel& level = levels_[static_cast<std::size_t>(l)];
    const bool judged = level.width * level.height < kMostJudged;
    const bool warped = judged && judgeAgain(current, l, starts.front(), at);
    refine(current, l, warped, at);
  }
  return at;
}

void MotionAligner::sum(int l, const Alignment& at, bool robust) {
  const double scale = scales_[static_cast<std::size_t>(l)];
  equations_.sum(level(l), frame_, lightOf(config_), at.gain, robust ? robust::kTukey * scale : 0.0);
}

// A^-1 B A^-1 with A = J'WJ and B the sum of the blocks' (J'Wr)(J'Wr)'.
std::optional<tracking::Matrix8d> MotionAligner::covariance() const {
  Matrix10d a = equations_.matrix();
  Vector10d b = equations_.vector();
  restrictTo(a, b, parametersOf(config_.model), config_.light, config_.light);
  const tracking::Factors<10> factors(a);
  if (!(factors.conditioning() > kSingular)) return std::nullopt;
  const int unknowns = parametersOf(config_.model);
  Matrix10d scores = Matrix10d::Zero();
  int count = 0;
  for (const tracking::LightBlockSums& block : equations_.blocks()) {
    if (!(block.weight > 0.0)) continue;
    Vector10d score = block.score;
    score.segment(unknowns, 8 - unknowns).setZero();
    if (!config_.light) score.tail<2>().setZero();
    scores += score * score.transpose();
    ++count;
  }
  const double freedom = std::max(1.0, count - unknowns - 2.0) / std::max(1, count);
  const Matrix10d inverse = factors.solve(Matrix10d::Identity());
  const tracking::Matrix8d x = (inverse * scores * inverse).topLeftCorner<8, 8>() / freedom;
  const tracking::Matrix8d t = fieldFromSl3(tracking::halfSize(frame_));
  tracking::Matrix8d covariance = t * x * t.transpose();
  covariance.diagonal().head<2>().array() += std::pow(kInterpolation * level(0).scale, 2);
  return covariance;
}

}  // namespace laparoscope_servo::motion
