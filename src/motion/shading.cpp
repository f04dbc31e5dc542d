#include "motion/shading.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "laparoscope_servo/image/multiversion.h"
#include "laparoscope_servo/robust/median.h"
#include "laparoscope_servo/robust/scale.h"
#include "laparoscope_servo/robust/weights.h"

namespace laparoscope_servo::motion {

namespace {

constexpr int kColumns = 12, kRows = 9;  // of blocks: of an image of 640 x 480 some 53 px a side
constexpr std::size_t kFewest = 18;      // blocks: three for each coefficient
constexpr double kShown = 0.5;           // of a block's pixels have to be used
constexpr double kDark = 10.0;           // grey levels, mean of a block: below, its ratio is that of noise
constexpr double kLeastScale = 0.01;     // of the ratios, which differ by that where the motion is off by half a pixel
constexpr int kIterations = 4;
constexpr double kLeast = 0.25, kMost = 4.0;  // bounds of the correction

LAPAROSCOPE_SERVO_CLONES
void multiply(float* __restrict row, int count, float a, float b, float c, float step) {
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float x = step * static_cast<float>(i) - 1.0f;
    const float factor = a + x * (b + x * c);
    row[i] *= std::min(std::max(factor, static_cast<float>(kLeast)), static_cast<float>(kMost));
  }
}

double along(double index, int count) {
  return 2.0 * index / std::max(1, count - 1) - 1.0;
}

}  // namespace

Shading::Shading() {
  forget();
  blocks_.reserve(kColumns * kRows);
  scratch_.reserve(kColumns * kRows);
}

void Shading::forget() {
  polynomial_ = Coefficients::Unit(0);
}

Shading::Coefficients Shading::termsAt(double x, double y) {
  Coefficients terms;
  terms << 1.0, x, y, x * x, x * y, y * y;
  return terms;
}

double Shading::at(double x, double y) const {
  return std::clamp(polynomial_.dot(termsAt(x, y)), kLeast, kMost);
}

void Shading::correct(tracking::EsmLevel& level) const {
  const Eigen::Matrix<float, 6, 1> p = polynomial_.cast<float>();
  const float step = 2.0f / static_cast<float>(std::max(1, level.width - 1));
  for (int j = 0; j < level.height; ++j) {
    const float y = static_cast<float>(along(j, level.height));
    multiply(level.planes[0].warped.row(j), level.width, p[0] + y * (p[2] + y * p[5]), p[1] + y * p[4], p[3], step);
  }
}

void Shading::fit(const tracking::EsmLevel& level) {
  const tracking::EsmPlane& plane = level.planes[0];
  const image::Patch& weight = level.usedWeight();
  blocks_.clear();
  for (int row = 0; row < kRows; ++row) {
    const int top = row * level.height / kRows, bottom = (row + 1) * level.height / kRows;
    for (int column = 0; column < kColumns; ++column) {
      const int left = column * level.width / kColumns, right = (column + 1) * level.width / kColumns;
      double used = 0.0, reference = 0.0, image = 0.0;
      for (int j = top; j < bottom; ++j) {
        for (int i = left; i < right; ++i) {
          const double w = static_cast<double>(weight(j, i));
          used += w;
          reference += w * static_cast<double>(plane.value(j, i));
          image += w * static_cast<double>(plane.warped(j, i));
        }
      }
      if (!(used > kShown * (bottom - top) * (right - left)) || !(std::min(reference, image) > kDark * used)) continue;
      blocks_.push_back({along(0.5 * (left + right - 1), level.width), along(0.5 * (top + bottom - 1), level.height),
                         reference / image});
    }
  }
  if (blocks_.size() < kFewest) return;
  Coefficients p = polynomial_;
  scratch_.clear();
  for (const Block& block : blocks_) scratch_.push_back(block.ratio - p.dot(termsAt(block.x, block.y)));
  p[0] += robust::median(scratch_);
  for (int k = 0; k < kIterations; ++k) {
    scratch_.clear();
    for (const Block& block : blocks_) scratch_.push_back(std::abs(block.ratio - p.dot(termsAt(block.x, block.y))));
    const double scale = std::max(kLeastScale, robust::kMadToSigma * robust::median(scratch_));
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Coefficients right = Coefficients::Zero();
    for (const Block& block : blocks_) {
      const Coefficients terms = termsAt(block.x, block.y);
      const double w = robust::tukeyWeight((block.ratio - p.dot(terms)) / scale);
      normal += w * terms * terms.transpose();
      right += w * block.ratio * terms;
    }
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(normal);
    if (!(solver.vectorD().minCoeff() > 1e-3)) return;
    p = solver.solve(right);
  }
  if (p.allFinite()) polynomial_ = p;
}

}  // namespace laparoscope_servo::motion
