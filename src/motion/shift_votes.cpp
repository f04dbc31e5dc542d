#include "motion/shift_votes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::motion {

namespace {

constexpr int kBlock = 10;       // px of the level: enough for one place to differ from another
constexpr double kShown = 0.75;  // of a block's pixels have to be in the image

LAPAROSCOPE_SERVO_CLONES
void subtract(const float* __restrict image, const float* __restrict reference, int count, float* __restrict difference,
              float* __restrict square) {
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float d = image[i] - reference[i];
    difference[i] = d;
    square[i] = d * d;
  }
}

}  // namespace

void ShiftVotes::compare(const tracking::EsmLevel& reference, const cv::Mat1f& current, int shift) {
  const int down = shift / kAlong - kReach, right = shift % kAlong - kReach;
  const int begin = std::max(0, -right), end = std::min(reference.width, reference.width - right);
  for (int j = std::max(0, -down); j < std::min(reference.height, reference.height - down); ++j) {
    subtract(current.ptr<float>(j + down) + begin + right, reference.planes[0].value.row(j) + begin, end - begin,
             difference_.data() + begin, square_.data() + begin);
    Block* row = blocks_.data() + j / kBlock * columns_;
    for (int first = 0; first < reference.width; first += kBlock) {
      Block& block = row[first / kBlock];
      float sum = 0.0f, squares = 0.0f;
      const int from = std::max(first, begin), to = std::min(first + kBlock, end);
      for (int i = from; i < to; ++i) {
        sum += difference_[static_cast<std::size_t>(i)];
        squares += square_[static_cast<std::size_t>(i)];
      }
      block.sum[shift] += static_cast<double>(sum);
      block.squares[shift] += static_cast<double>(squares);
      block.pixels[shift] += std::max(0, to - from);
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
    const auto misfit = [&](int shift) {
      const int pixels = block.pixels[shift];
      if (pixels < kShown * width * height) return std::numeric_limits<double>::infinity();
      return (block.squares[shift] - block.sum[shift] * block.sum[shift] / pixels) / pixels;
    };
    int best = 0;
    for (int shift = 1; shift < kAlong * kAlong; ++shift) {
      if (misfit(shift) < misfit(best)) best = shift;
    }
    double second = std::numeric_limits<double>::infinity();
    for (int shift = 0; shift < kAlong * kAlong; ++shift) {
      const bool apart = std::abs(shift / kAlong - best / kAlong) > 1 || std::abs(shift % kAlong - best % kAlong) > 1;
      if (apart) second = std::min(second, misfit(shift));
    }
    if (!(second > 0.0) || !std::isfinite(second)) continue;
    votes_.push_back({Eigen::Vector2d(best % kAlong - kReach, best / kAlong - kReach), 1.0 - misfit(best) / second});
  }
}

Eigen::Vector2d ShiftVotes::find(const tracking::EsmLevel& reference, const cv::Mat1f& current) {
  columns_ = (reference.width + kBlock - 1) / kBlock;
  const int rows = (reference.height + kBlock - 1) / kBlock;
  blocks_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows), Block{});
  votes_.reserve(blocks_.size());
  difference_.resize(static_cast<std::size_t>(reference.width));
  square_.resize(static_cast<std::size_t>(reference.width));
  for (int shift = 0; shift < kAlong * kAlong; ++shift) compare(reference, current, shift);
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
