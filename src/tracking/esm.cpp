#include "laparoscope_servo/tracking/esm.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "esm_kernels.h"
#include "laparoscope_servo/geometry/sl3.h"
#include "laparoscope_servo/image/warp.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr double kTukey = 4.6851;       // 95 % efficiency for normal noise (Marchand and Chaumette 2004, appendix)
constexpr double kMadToSigma = 1.4826;  // normal noise
constexpr double kMinSigma = 1.0;       // grey levels; below it quantisation is mistaken for outliers
constexpr int kMaxSamples = 1024;       // of the residual, for its scale
constexpr int kRun = 4;                 // px side by side, which share what is fetched from memory
constexpr double kBinsPerLevel = 8.0;   // of the histogram of residuals, which ends at 128 grey levels
constexpr int kBins = 1024;

// Steps shrink by about this factor from one to the next before that has been measured.
constexpr double kContraction = 0.3;
constexpr double kSlowest = 0.9;         // steps that shrink by less do not converge
constexpr double kCoarseAccuracy = 0.1;  // px of the level, enough for the next finer one
constexpr int kPatience = 10;            // iterations on levels that are reached from a coarser one, for the steps to become short
constexpr double kFar = 0.5;             // px of the level, a step after which the region may still be elsewhere
constexpr int kHurry = 2;                // iterations on the first level for the steps to become short, or the region is far
constexpr int kShifts = 4;               // first steps on a coarse level, if far
constexpr double kSameLight = 0.5;       // of the residual's scale, for its mean
constexpr int kTrials = 8;               // iterations with the light of the start, if far

// Surprise, chi squared with 8 degrees of freedom, at which a prior begins to count less: Student's t with as many of its own.
constexpr double kFreedom = 8.0;

Eigen::Matrix3d scaling(double s, double x, double y) {
  Eigen::Matrix3d m;
  m << s, 0.0, x,  //
      0.0, s, y,   //
      0.0, 0.0, 1.0;
  return m;
}

// The derivative of a corner's image, in normalised template units, at the identity: the rows of J for unit gradients.
Eigen::Matrix<double, 2, 8> cornerJacobian(const Eigen::Vector2d& p) {
  Eigen::Matrix<double, 2, 8> j;
  j.row(0) = esmJacobianRow(1.0, 0.0, p.x(), p.y());
  j.row(1) = esmJacobianRow(0.0, 1.0, p.x(), p.y());
  return j;
}

// How far the image of `p` moves for a motion of it in the plane of the reference.
Eigen::Matrix2d derivative(const Eigen::Matrix3d& g, const Eigen::Vector2d& p) {
  const Eigen::Vector3d q = g * p.homogeneous();
  const Eigen::Vector2d image = q.hnormalized();
  return (g.topLeftCorner<2, 2>() - image * g.bottomLeftCorner<1, 2>()) / q.z();
}

// A matrix that its diagonal has been divided out of: grey levels and normalised coordinates have nothing to do with each other.
template <int N>
class Factors {
 public:
  using Matrix = Eigen::Matrix<double, N, N>;
  explicit Factors(const Matrix& a)
      : d_(a.diagonal().cwiseMax(1e-12).cwiseSqrt().cwiseInverse()), ldlt_(d_.asDiagonal() * a * d_.asDiagonal()) {}
  // 0 for a singular matrix, 1 for a diagonal one.
  double conditioning() const { return ldlt_.info() == Eigen::Success ? ldlt_.vectorD().minCoeff() : 0.0; }
  template <typename Right>
  auto solve(const Right& b) const {
    return (d_.asDiagonal() * ldlt_.solve(d_.asDiagonal() * b)).eval();
  }

 private:
  Eigen::Matrix<double, N, 1> d_;
  Eigen::LDLT<Matrix> ldlt_;
};

// How much a prior counts that expected x = 0.
double credibility(const MotionPrior& prior, const geometry::Vector8d& x) {
  return 2.0 * kFreedom / (kFreedom + x.dot(prior.information * x));
}

}  // namespace

void Esm::setReference(const image::RegionPyramid& reference, const geometry::Rectangle& roi) {
  roi_ = roi;
  half_size_ = std::max(roi.width, roi.height) / 2.0;
  n_ = scaling(1.0 / half_size_, -roi.centre().x() / half_size_, -roi.centre().y() / half_size_);
  n_inv_ = n_.inverse();
  levels_.clear();
  forgetLight();
  for (int l = 0; l < std::min(config_.levels, reference.levels()); ++l) {
    EsmLevel level(reference, roi, l, lens_.get());
    if (level.planes.empty()) break;
    if (config_.light == Light::kLocal) level.centreLight();
    if (l > 0) matchBlocks(level, levels_.back());
    levels_.push_back(std::move(level));
  }
}

void Esm::setWeights(const cv::Mat1f& weights) {
  EsmLevel& finest = levels_[0];
  for (int j = 0; j < finest.height; ++j) std::copy_n(weights.ptr<float>(j), finest.width, finest.weight.row(j));
  for (std::size_t l = 1; l < levels_.size(); ++l) coarsenWeights(levels_[l - 1], scratch_, levels_[l]);
}

void Esm::warp(const image::RegionPyramid& current, EsmLevel& level, int l, const Eigen::Matrix3d& g) {
  const double size = level.scale;
  const Eigen::Matrix3d level_T_image = scaling(1.0 / size, -current.origin().x / size, -current.origin().y / size);
  const Eigen::Matrix3d level_T_patch = level_T_image * g * level.image_T_patch;
  for (std::size_t c = 0; c < level.planes.size(); ++c) {
    const int channel = std::min(static_cast<int>(c), current.channels() - 1);  // an image without colour stands for all
    image::Patch& warped = level.planes[c].warped;
    level.all_valid = lens_ ? image::warpBilinear(current.level(l, channel), g * level.image_T_patch, *lens_,
                                                  {current.origin(), size}, warped, level.valid)
                            : image::warpBilinear(current.level(l, channel), level_T_patch, warped, level.valid);
    warped.extrapolate();
  }
  if (!level.all_valid) level.useValid();
}

void Esm::forgetLight() { light_known_ = false; }

// That of the last image, where it is known. Else one bias for all, so that what the blocks differ by still pulls at the motion.
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

// One more bias for all, which leaves no mean residual; gain and blocks stay. Returns the bias.
double Esm::matchMean(EsmLevel& level, EsmState& state) {
  const image::Patch& weight = level.usedWeight();
  double common = 0.0;
  for (EsmPlane& plane : level.planes) {
    double sum = 0.0, weights = 0.0;
    for (int row = 0; row + 1 < static_cast<int>(level.block_row_begin.size()); ++row) {
      for (int j = level.block_row_begin[row]; j < level.block_row_begin[row + 1]; ++j) {
        for (int i = 0; i < level.width; ++i) {
          const double bias = plane.biasOf(row * level.block_columns + level.block_of_strip[i / image::Patch::kStrip], state.gain);
          sum += weight(j, i) * (plane.value(j, i) - state.gain * plane.warped(j, i) - bias);
          weights += weight(j, i);
        }
      }
    }
    const double missing = weights > 0.0 ? sum / weights : 0.0;
    for (double& bias : plane.bias) bias += missing;
    common += missing / static_cast<double>(level.planes.size());
  }
  state.bias += common;
  return common;
}

double Esm::residualScale(const EsmLevel& level, const EsmState& state) {
  histogram_.assign(kBins, 0);
  const image::Patch& weight = level.usedWeight();
  const int pixels = level.width * level.height * static_cast<int>(level.planes.size());
  const int stride = kRun * std::max(1, pixels / kMaxSamples);
  const float gain = static_cast<float>(state.gain);
  int count = 0;
  for (const EsmPlane& plane : level.planes) {
    std::size_t block_row = 0;
    for (int j = 0; j < level.height; ++j) {
      if (j >= level.block_row_begin[block_row + 1]) ++block_row;
      const float* weights = weight.row(j);
      const float* image = plane.warped.row(j);
      const float* reference = plane.value.row(j);
      // Runs that start elsewhere in each row, so that no pattern of the image is preferred.
      for (int first = (j * 7 * kRun) % stride / kRun * kRun; first < level.width; first += stride) {
        const std::size_t block = block_row * level.block_columns + level.block_of_strip[first / image::Patch::kStrip];
        const float b = static_cast<float>(plane.biasOf(block, state.gain));
        for (int i = first; i < std::min(first + kRun, level.width); ++i) {
          if (!(weights[i] > 0.0f)) continue;
          const float residual = std::abs(gain * image[i] + b - reference[i]);
          ++histogram_[std::min(static_cast<int>(residual * static_cast<float>(kBinsPerLevel)), kBins - 1)];
          ++count;
        }
      }
    }
  }
  if (count == 0) return kMinSigma;
  // The median lies in the bin where half of the samples are reached, as far along as they are reached there.
  double below = 0.0;
  int bin = 0;
  while (below + histogram_[bin] < 0.5 * count) below += histogram_[bin++];
  const double median = (bin + (0.5 * count - below) / histogram_[bin]) / kBinsPerLevel;
  return std::max(kMinSigma, kMadToSigma * median);
}

void Esm::accumulate(const EsmLevel& level, const EsmState& state, double sigma) {
  CellInput input;
  input.weight = &level.usedWeight();
  input.gain = static_cast<float>(state.gain);
  input.inverse_rejection = config_.robust ? static_cast<float>(1.0 / (kTukey * sigma)) : 0.0f;
  // The kernel adds both gradients; J takes their mean, per normalised unit.
  equations_.reset(light_, 0.5 * half_size_ / level.scale);
  block_sums_.clear();
  for (const EsmPlane& plane : level.planes) {
    input.image = &plane.warped;
    input.reference = &plane.value;
    for (int row = 0; row + 1 < static_cast<int>(level.block_row_begin.size()); ++row) {
      accumulateBlocks(level, input, plane, row);
    }
  }
}

void Esm::accumulateBlocks(const EsmLevel& level, const CellInput& input, const EsmPlane& plane, int block_row) {
  const Eigen::Matrix3d unit_T_patch = n_ * level.image_T_patch;
  const int begin = level.block_row_begin[block_row];
  const int end = level.block_row_begin[block_row + 1];
  const int cell_rows = (end - begin + level.cell_rows - 1) / level.cell_rows;
  const int strips = level.weight.strips();
  strip_bias_.resize(strips);
  for (int strip = 0; strip < strips; ++strip) {
    const std::size_t block = block_row * level.block_columns + level.block_of_strip[strip];
    strip_bias_[strip] = static_cast<float>(plane.biasOf(block, input.gain));
  }
  const int per_strip = level.cells_per_strip;
  cells_.resize(static_cast<std::size_t>(cell_rows) * strips * per_strip);
  for (int k = 0; k < cell_rows; ++k) {
    const int row = begin + k * level.cell_rows;
    sumCells(input, row, std::min(level.cell_rows, end - row), per_strip, strip_bias_.data(),
             cells_.data() + k * strips * per_strip);
  }
  const int cell_columns = image::Patch::kStrip / per_strip;
  for (int strip = 0; strip < strips; ++strip) {
    for (int cell = strip * per_strip; cell < (strip + 1) * per_strip; ++cell) {
      const int columns = std::min(cell_columns, level.width - cell * cell_columns);
      if (columns <= 0) break;
      const double u = unit_T_patch(0, 2) + unit_T_patch(0, 0) * (cell * cell_columns + 0.5 * (columns - 1));
      for (int k = 0; k < cell_rows; ++k) {
        const int row = begin + k * level.cell_rows;
        const int rows = std::min(level.cell_rows, end - row);
        const double v = unit_T_patch(1, 2) + unit_T_patch(1, 1) * (row + 0.5 * (rows - 1));
        equations_.addCell(cells_[k * strips * per_strip + cell], u, v);
      }
    }
    if (strip + 1 < strips && level.block_of_strip[strip + 1] == level.block_of_strip[strip]) continue;
    equations_.endBlock();
    block_sums_.push_back(
        {equations_.blockWeight(), equations_.blockResidual(), equations_.blockJacobian(), equations_.blockScore()});
  }
}

bool Esm::solve(EsmLevel& level, const MotionPrior* prior, bool shift_only, EsmState& state, double& step) {
  Matrix10d a = equations_.matrix();
  Vector10d b = equations_.vector();
  if (prior != nullptr) {
    const double unit = prior->noise * credibility(*prior, deviation_);
    a.topLeftCorner<8, 8>() += unit * prior->information;
    b.head<8>() += unit * (prior->information * deviation_);
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
  deviation_ += x.head<8>();
  const geometry::Quadrilateral before = geometry::apply(state.g, roi_.corners());
  takeStep(level, x, state);
  const geometry::Quadrilateral after = geometry::apply(state.g, roi_.corners());
  step = 0.0;
  for (int k = 0; k < 4; ++k) step = std::max(step, (after[k] - before[k]).norm());
  return state.g.allFinite() && std::isfinite(step) && state.gain > 0.0;
}

void Esm::takeStep(EsmLevel& level, const Vector10d& x, EsmState& state) {
  state.g = state.g * n_inv_ * geometry::sl3Exp(x.head<8>()) * n_;
  state.g /= std::cbrt(state.g.determinant());
  state.gain += x[8];
  state.bias += x[9];
  double bias = 0.0;
  double weight = 0.0;
  auto sums = block_sums_.begin();
  for (EsmPlane& plane : level.planes) {
    for (std::size_t block = 0; block < plane.bias.size(); ++block, ++sums) {
      if (config_.light != Light::kLocal) {
        plane.bias[block] = state.bias;
      } else if (light_ == Light::kLocal && sums->weight > 0.0) {
        // The step is one of gain * image + bias; part of it is what the gain's does to the mean.
        plane.bias[block] += x[8] * plane.mean[block] - (sums->residual + sums->jacobian.dot(x)) / sums->weight;
        bias += sums->weight * plane.biasOf(block, state.gain);
        weight += sums->weight;
      }
    }
  }
  if (weight > 0.0) state.bias = bias / weight;
}

// The covariance that the residuals show is A^-1 B A^-1 with A = J'WJ and B the sum of the blocks' J'Wr times itself: whatever the
// residuals within a block have in common is in it. `noise` is the one number that makes A/noise as large as its inverse.
void Esm::judge(const MotionPrior* prior, EsmResult& result) {
  Matrix10d scores = Matrix10d::Zero();
  int blocks = 0;
  for (const BlockSums& sums : block_sums_) {
    if (!(sums.weight > 0.0)) continue;
    scores += sums.score * sums.score.transpose();
    ++blocks;
  }
  const Factors<10> factors(equations_.matrix());
  result.noise = result.sigma * result.sigma;
  result.corner_error = std::numeric_limits<double>::infinity();
  Matrix8d information = Matrix8d::Zero();
  if (factors.conditioning() > 1e-12) {
    const Matrix10d inverse = factors.solve(Matrix10d::Identity());
    const Matrix8d shape = inverse.topLeftCorner<8, 8>();
    const Matrix8d seen = (inverse * scores * inverse).topLeftCorner<8, 8>();
    const Factors<8> of_shape(shape);
    // Nine unknowns have been fitted to the blocks.
    const double freedom = std::max(1.0, blocks - 9.0) / std::max(1, blocks);
    const double seen_noise = of_shape.solve(seen).trace() / 8.0 / freedom;
    if (std::isfinite(seen_noise)) result.noise = std::max(result.noise, seen_noise);
    information = of_shape.solve(Matrix8d::Identity()) / result.noise;
  }
  if (prior != nullptr) information += credibility(*prior, deviation_) * prior->information;
  const Factors<8> posterior(information);
  if (!(posterior.conditioning() > 1e-12)) return;
  result.covariance = posterior.solve(Matrix8d::Identity());
  result.corner_error = cornerError(result.state.g, result.covariance);
}

double Esm::cornerError(const Eigen::Matrix3d& g, const Matrix8d& covariance) const {
  double worst = 0.0;
  for (const Eigen::Vector2d& corner : roi_.corners()) {
    const Eigen::Matrix<double, 2, 8> j = half_size_ * derivative(g, corner) * cornerJacobian(geometry::apply(n_, corner));
    worst = std::max(worst, (j * covariance * j.transpose()).trace());
  }
  return std::sqrt(worst);
}

double Esm::referenceCornerError(double sigma) {
  EsmLevel& level = levels_[0];
  for (EsmPlane& plane : level.planes) {
    for (int j = 0; j < level.height; ++j) std::copy_n(plane.value.row(j), level.width, plane.warped.row(j));
    plane.warped.extrapolate();
  }
  level.all_valid = true;
  accumulate(level, EsmState(), sigma);
  const Factors<10> factors(equations_.matrix());
  if (!(factors.conditioning() > 1e-12)) return std::numeric_limits<double>::infinity();
  const Matrix10d inverse = factors.solve(Matrix10d::Identity());
  return cornerError(Eigen::Matrix3d::Identity(), 2.0 * sigma * sigma * inverse.topLeftCorner<8, 8>());
}

EsmStatus Esm::iterate(const image::RegionPyramid& current, int l, const MotionPrior* prior, const Iteration& how, EsmResult& result) {
  EsmLevel& level = levels_[l];
  if (!geometry::isConvex(geometry::apply(result.state.g, roi_.corners()))) return EsmStatus::kOutOfView;
  warp(current, level, l, result.state.g);
  if (how.match_mean) matchMean(level, result.state);
  light_ = how.light;
  result.sigma = residualScale(level, result.state);
  accumulate(level, result.state, result.sigma);
  ++result.iterations;
  if (!solve(level, prior, how.shift_only, result.state, result.last_step)) return EsmStatus::kIllConditioned;
  return EsmStatus::kMaxIterations;
}

// Far from where the region belongs, the image says little of the light: a fit to what does not correspond would lower the gain, and
// blocks with a bias each would take up the very differences that pull at the motion. So the light is that of the start, and the first
// steps on a coarse level are shifts. If that leads nowhere, once more with the mean matched at each step.
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
      if (status != EsmStatus::kMaxIterations) break;
      if (result.last_step > kFar * level.scale) continue;
      // Near, the mean is that of the reference; where it is not, the light has changed.
      if (match || std::abs(matchMean(level, result.state)) < kSameLight * result.sigma) return EsmStatus::kConverged;
      break;
    }
  }
  return status;
}

// From the second step on the ratio of two steps tells how fast they shrink, and how far there is still to go.
EsmStatus Esm::settle(const image::RegionPyramid& current, int l, int patience, const MotionPrior* prior, EsmResult& result) {
  const double scale = levels_[l].scale;
  const double accuracy = l == 0 ? config_.min_step : std::max(config_.min_step, kCoarseAccuracy * scale);
  double contraction = kContraction;
  for (int k = 0; k < config_.max_iterations; ++k) {
    const double before = result.last_step;
    const EsmStatus status = iterate(current, l, prior, {config_.light, false, false}, result);
    if (status != EsmStatus::kMaxIterations) return status;
    if (k > 0) contraction = std::min(result.last_step / std::max(before, 1e-9), kSlowest);
    if (result.last_step * contraction / (1.0 - contraction) < accuracy) return EsmStatus::kConverged;
    if (k >= patience && result.last_step > kFar * scale) break;
  }
  return EsmStatus::kMaxIterations;
}

// Whether the way is far, where the light is not known, a first iteration with one gain and one bias tells.
EsmStatus Esm::alignLevel(const image::RegionPyramid& current, int l, bool first, const MotionPrior* prior, EsmResult& result) {
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

EsmResult Esm::align(const image::RegionPyramid& current, const EsmState& start, const MotionPrior* prior, int coarsest) {
  EsmResult result;
  result.state = start;
  result.corner_error = std::numeric_limits<double>::infinity();
  deviation_.setZero();
  if (prior != nullptr && prior->predicted != start.g) {
    deviation_ = geometry::sl3Log(geometry::normaliseDeterminant(n_ * prior->predicted.inverse() * start.g * n_inv_));
    if (!deviation_.allFinite()) prior = nullptr;
  }
  const int first = std::min({coarsest, levels() - 1, current.levels() - 1});
  for (int l = first; l >= 0; --l) {
    for (EsmPlane& plane : levels_[l].planes) plane.before = plane.bias;
    if (l < first && light_known_ && config_.light == Light::kLocal) inheritLight(levels_[l + 1], levels_[l]);
    result.status = alignLevel(current, l, l == first, prior, result);
    if (result.status == EsmStatus::kOutOfView || result.status == EsmStatus::kIllConditioned) return result;
    // What does not settle on a coarse level is not there.
    if (result.status == EsmStatus::kMaxIterations && result.last_step > kFar * levels_[l].scale) return result;
  }
  light_known_ = true;
  judge(prior, result);
  return result;
}

}  // namespace laparoscope_servo::tracking
