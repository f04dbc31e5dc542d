#include "motion/motion_support.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "laparoscope_servo/robust/scale.h"
#include "motion/float_median.h"

namespace laparoscope_servo::motion {

namespace {

constexpr int kLevel = 1;            // half as fine: four pixels of noise less, a quarter of the time
constexpr double kSay = 0.25;        // px of the level: a cell has a say in directions that it shows so well
constexpr double kTolerance = 0.35;  // px of the level, and
constexpr double kDeviations = 2.0;  // standard deviations, by which a cell that follows may be off
constexpr double kKept = 0.5;        // of a cell's gradient energy, that Tukey's weights have to keep
constexpr double kSeen = 0.5;        // of a cell's pixels, that have to be usable
constexpr int kEvery = 4;            // px along a row, from sample to sample of the residuals
// Grey levels: as ResidualScale has it; and where residuals scatter by more nothing was aligned, which is not the
// texture's fault.
constexpr double kLeastSigma = 1.0, kMostSigma = 4.0;

// What a cell says of the motion that is left in it, light apart. `noise`: what noise adds to the square of a pixel's
// gradient in each direction.
unsigned char verdict(const tracking::CellSums& cell, double pixels, double sigma, double noise, double kept) {
  if (!(static_cast<double>(cell.w) > kSeen * pixels)) return MotionSupport::kSilent;
  const CellShift shift = shiftOf(cell);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(shift.matrix);
  bool says = false, follows = true;
  for (int k = 0; k < 2; ++k) {
    const double information = solver.eigenvalues()[k] - static_cast<double>(cell.w) * noise;
    const double deviation = sigma / std::sqrt(std::max(information, 1e-12));
    if (!(deviation < kSay)) continue;
    says = true;
    const double left = std::abs(solver.eigenvectors().col(k).dot(shift.vector) / information);
    follows = follows && left < kTolerance + kDeviations * deviation;
  }
  if (!says) return MotionSupport::kSilent;
  const double energy = static_cast<double>(cell.xx + cell.yy);
  return follows && kept > kKept * energy ? MotionSupport::kFollows : MotionSupport::kForeign;
}

}  // namespace

void MotionSupport::clear() {
  map_.setTo(kSilent);
  share_ = textured_ = sigma_ = 0.0;
}

void MotionSupport::judge(MotionAligner& aligner, const MotionImage& current, const Alignment& at) {
  level_ = std::min(kLevel, aligner.levels() - 1);
  aligner.warp(current, level_, at);
  aligner.sum(level_, at, true);
  const tracking::EsmLevel& level = aligner.level(level_);
  const int columns = level.weight.strips() * level.cells_per_strip;
  const int width = image::Patch::kStrip / level.cells_per_strip;
  const int rows = (level.height + level.cell_rows - 1) / level.cell_rows;
  map_.create(rows, (level.width + width - 1) / width);
  cell_ = cv::Size(width, level.cell_rows) * static_cast<int>(level.scale);
  kept_.clear();
  for (int k = 0; k < rows * columns; ++k) {
    const tracking::CellSums& cell = aligner.equations().cells()[static_cast<std::size_t>(k)];
    kept_.push_back(static_cast<double>(cell.xx + cell.yy));
  }
  aligner.sum(level_, at, false);
  const double sigma = std::clamp(aligner.scales()[static_cast<std::size_t>(level_)], kLeastSigma, kMostSigma);
  if (level_scale_ != level.scale) {
    level_scale_ = level.scale;
    const image::LevelNoise white = image::levelNoise(static_cast<int>(level.scale));
    // Each image contributes half of the residual's variance; the mean of two gradients has half the variance of one.
    noise_ = white.gradient / (8.0 * white.deviation * white.deviation);
  }
  double following = 0.0, saying = 0.0;
  int textured = 0;
  for (int j = 0; j < map_.rows; ++j) {
    const int height = std::min(level.cell_rows, level.height - j * level.cell_rows);
    for (int i = 0; i < map_.cols; ++i) {
      const std::size_t k = static_cast<std::size_t>(j * columns + i);
      const tracking::CellSums& cell = aligner.equations().cells()[k];
      const double pixels = height * std::min(width, level.width - i * width);
      map_(j, i) = verdict(cell, pixels, sigma, noise_ * sigma * sigma, kept_[k]);
      if (map_(j, i) == kSilent) continue;
      const double energy = static_cast<double>(cell.xx + cell.yy);
      ++textured;
      saying += energy;
      if (map_(j, i) == kFollows) following += energy;
    }
  }
  share_ = saying > 0.0 ? following / saying : 0.0;
  textured_ = static_cast<double>(textured) / static_cast<double>(map_.total());
  measureScale(level, at.gain);
}

void MotionSupport::measureScale(const tracking::EsmLevel& level, double gain) {
  magnitudes_.clear();
  magnitudes_.reserve(static_cast<std::size_t>(level.width / kEvery + 1) * static_cast<std::size_t>(level.height));
  const tracking::EsmPlane& plane = level.planes[0];
  const image::Patch& weight = level.usedWeight();
  const int width = cell_.width / static_cast<int>(level.scale);
  std::size_t row = 0;  // of blocks of light
  for (int j = 0; j < level.height; ++j) {
    if (j == level.light_row_begin[row + 1]) ++row;
    const unsigned char* cells = map_[j / level.cell_rows];
    for (int i = j % kEvery; i < level.width; i += kEvery) {
      if (cells[i / width] != kFollows || !(weight(j, i) > 0.0f)) continue;
      const int column = level.light_column_of_strip[static_cast<std::size_t>(i / image::Patch::kStrip)];
      const std::size_t block = row * static_cast<std::size_t>(level.light_columns) + static_cast<std::size_t>(column);
      const float offset = static_cast<float>(plane.biasOf(block, gain));
      magnitudes_.push_back(std::abs(static_cast<float>(gain) * plane.warped(j, i) + offset - plane.value(j, i)));
    }
  }
  sigma_ = magnitudes_.empty()
               ? 0.0
               : std::max(kLeastSigma, robust::kMadToSigma * static_cast<double>(floatMedian(magnitudes_)));
}

}  // namespace laparoscope_servo::motion
