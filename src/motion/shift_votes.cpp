#include "motion/shift_votes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::motion {

namespace {

constexpr int kBlock = 10;       // px of the level: enough for one place to differ from another
constexpr double kShown = 0.75;  // of a block's pixels have to be in the image

// Compares a row of the reference, piece by piece, with a row of the image from `lanes` places on, and adds the
// differences and their squares to those of the pieces' blocks, `stride` numbers apart. `inside`: 0 for places that do
// not count, else 1.
LAPAROSCOPE_SERVO_CLONES
void addDifferences(const float* __restrict image, const float* __restrict inside, const float* __restrict reference,
                    int width, double* __restrict sum, double* __restrict squares, std::size_t stride) {
  constexpr int kLanes = 8;
  for (int first = 0; first < width; first += kBlock, sum += stride, squares += stride) {
    float s[kLanes] = {}, q[kLanes] = {};
    const int end = first + kBlock < width ? first + kBlock : width;
    for (int i = first; i < end; ++i) {
#pragma omp simd
      for (int k = 0; k < kLanes; ++k) {
        const float d = inside[i + k] * (image[i + k] - reference[i]);
        s[k] += d;
        q[k] += d * d;
      }
    }
#pragma omp simd
    for (int k = 0; k < kLanes; ++k) {
      sum[k] += static_cast<double>(s[k]);
      squares[k] += static_cast<double>(q[k]);
    }
  }
}

}  // namespace

void ShiftVotes::compare(const tracking::EsmLevel& reference, const cv::Mat1f& current, int down) {
  const std::size_t place = static_cast<std::size_t>(down + kReach);
  for (int j = std::max(0, -down); j < std::min(reference.height, reference.height - down); ++j) {
    std::copy_n(current.ptr<float>(j + down), reference.width, row_.begin() + kReach);
    Block* const row = blocks_.data() + j / kBlock * columns_;
    addDifferences(row_.data(), inside_.data(), reference.planes[0].value.row(j), reference.width, row->sum[place],
                   row->squares[place], sizeof(Block) / sizeof(double));
    for (int column = 0; column < columns_; ++column) {
      const int first = column * kBlock, last = std::min(first + kBlock, reference.width);
      for (int right = -kReach; right <= kReach; ++right) {
        const int from = std::max(first, -right), to = std::min(last, reference.width - right);
        row[column].pixels[place][right + kReach] += std::max(0, to - from);
      }
    }
  }
}

// A block's vote counts by how much worse it fits anywhere but beside its place.
void ShiftVotes::vote(const tracking::EsmLevel& reference) {
  votes_.clear();
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const Block& block = blocks_[k];
    const int column = static_cast<int>(k) % columns_ * kBlock, row = static_cast<int>(k) / columns_ * kBlock;
    const int width = std::min(kBlock, reference.width - column), height = std::min(kBlock, reference.height - row);
    double weight = 0.0;
    for (int j = row; j < row + height; ++j) {
      for (int i = column; i < column + width; ++i) weight += static_cast<double>(reference.weight(j, i));
    }
    if (weight < kShown * kBlock * kBlock) continue;
    std::array<double, kAlong * kAlong> misfit;
    for (int shift = 0; shift < kAlong * kAlong; ++shift) {
      const int down = shift / kAlong, right = shift % kAlong, pixels = block.pixels[down][right];
      const double sum = block.sum[down][right];
      misfit[static_cast<std::size_t>(shift)] = pixels < kShown * width * height
                                                    ? std::numeric_limits<double>::infinity()
                                                    : (block.squares[down][right] - sum * sum / pixels) / pixels;
    }
    const auto least = std::min_element(misfit.begin(), misfit.end());
    const int best = static_cast<int>(least - misfit.begin());
    double second = std::numeric_limits<double>::infinity();
    for (int shift = 0; shift < kAlong * kAlong; ++shift) {
      const bool apart = std::abs(shift / kAlong - best / kAlong) > 1 || std::abs(shift % kAlong - best % kAlong) > 1;
      if (apart) second = std::min(second, misfit[static_cast<std::size_t>(shift)]);
    }
    if (!(second > 0.0) || !std::isfinite(second)) continue;
    votes_.push_back({Eigen::Vector2d(best % kAlong - kReach, best / kAlong - kReach), 1.0 - *least / second});
  }
}

Eigen::Vector2d ShiftVotes::find(const tracking::EsmLevel& reference, const cv::Mat1f& current) {
  columns_ = (reference.width + kBlock - 1) / kBlock;
  const int rows = (reference.height + kBlock - 1) / kBlock;
  blocks_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows), Block{});
  votes_.reserve(blocks_.size());
  const std::size_t width = static_cast<std::size_t>(reference.width);
  row_.assign(width + kLanes, 0.0f);
  inside_.assign(width + kLanes, 0.0f);
  std::fill_n(inside_.begin() + kReach, width, 1.0f);
  for (int down = -kReach; down <= kReach; ++down) compare(reference, current, down);
  vote(reference);
  Eigen::Vector2d best = Eigen::Vector2d::Zero();
  double most = 0.0;
  for (const Vote& candidate : votes_) {
    double weight = 0.0;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Vote& other : votes_) {
      if ((other.shift - candidate.shift).lpNorm<Eigen::Infinity>() > 1.0) continue;
      weight += other.weight;
      sum += other.weight * other.shift;
    }
    if (weight > most) {
      most = weight;
      best = sum / weight;
    }
  }
  return best;
}

}  // namespace laparoscope_servo::motion
