#include "laparoscope_servo/features/coarse_motion.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "laparoscope_servo/robust/draws.h"
#include "laparoscope_servo/robust/largest.h"

namespace laparoscope_servo::features {

namespace {

constexpr int kHypotheses = 64;  // with 40 % of the candidates right, three are in one of 64 triples but for 1.4 %
constexpr int kDraw = 3;
constexpr double kEnough = 0.75;    // share of the score that all sites on edges would have: no other motion has more
constexpr double kTolerance = 2.5;  // px: what a sample every other pixel, and a curve that changes its shape, leave
constexpr double kNoise = 0.7;      // px, of one candidate

// What is known of the motion beforehand: it may be of the range, growth and turn of half of it.
Eigen::Matrix4d information(double range) {
  const double stiff = 1.0 / (range * range);
  return Eigen::Vector4d(stiff, stiff, 4.0 * stiff, 4.0 * stiff).asDiagonal();
}

double agreement(double error) {
  const double t = error / kTolerance;
  return t * t < 1.0 ? 1.0 - t * t : 0.0;
}

}  // namespace

void CoarseMotion::reserve(int sites) {
  rows_.reserve(static_cast<std::size_t>(sites));
  with_candidates_.reserve(static_cast<std::size_t>(sites));
}

void CoarseMotion::describe(const std::vector<Site>& sites, const std::vector<WeightedCandidates>& candidates) {
  centre_.setZero();
  for (const Site& site : sites) centre_ += site.point;
  centre_ /= static_cast<double>(sites.size());
  double squares = 0.0;
  for (const Site& site : sites) squares += (site.point - centre_).squaredNorm();
  radius_ = std::max(1.0, std::sqrt(squares / static_cast<double>(sites.size())));
  rows_.clear();
  with_candidates_.clear();
  most_ = 0.0;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Eigen::Vector2d arm = (sites[i].point - centre_) / radius_, n = sites[i].normal;
    rows_.emplace_back(n.x(), n.y(), n.dot(arm), n.y() * arm.x() - n.x() * arm.y());
    float best = 0.0f;
    for (int k = 0; k < candidates[i].found.count; ++k) {
      best = std::max(best, candidates[i].weight[static_cast<std::size_t>(k)]);
    }
    if (!(best > 0.0f) || sites[i].probe) continue;
    with_candidates_.push_back(static_cast<int>(i));
    most_ += static_cast<double>(best);
  }
}

double CoarseMotion::score(const std::vector<WeightedCandidates>& candidates, const Motion& motion) const {
  double sum = 0.0;
  for (const int i : with_candidates_) {
    const WeightedCandidates& all = candidates[static_cast<std::size_t>(i)];
    const double moved = rows_[static_cast<std::size_t>(i)].dot(motion);
    double best = 0.0;
    for (int k = 0; k < all.found.count; ++k) {
      const std::size_t at = static_cast<std::size_t>(k);
      best = std::max(
          best, static_cast<double>(all.weight[at]) * agreement(static_cast<double>(all.found.at[at].offset) - moved));
    }
    sum += best;
  }
  return sum;
}

CoarseMotion::Motion CoarseMotion::refined(const std::vector<WeightedCandidates>& candidates, const Motion& motion,
                                           double range) const {
  Eigen::Matrix4d normal = information(range);
  Motion right = Motion::Zero();
  for (const int i : with_candidates_) {
    const WeightedCandidates& all = candidates[static_cast<std::size_t>(i)];
    const Eigen::Vector4d& row = rows_[static_cast<std::size_t>(i)];
    double best = 0.0, offset = 0.0;
    for (int k = 0; k < all.found.count; ++k) {
      const std::size_t at = static_cast<std::size_t>(k);
      const double here = static_cast<double>(all.found.at[at].offset);
      const double weight = static_cast<double>(all.weight[at]) * agreement(here - row.dot(motion));
      if (weight > best) {
        best = weight;
        offset = here;
      }
    }
    const double weight = best / (kNoise * kNoise);
    normal += weight * row * row.transpose();
    right += weight * offset * row;
  }
  return normal.ldlt().solve(right);
}

CoarseResult CoarseMotion::find(const std::vector<Site>& sites, const std::vector<WeightedCandidates>& candidates,
                                double range) {
  CoarseResult result;
  if (sites.empty()) return result;
  describe(sites, candidates);
  if (with_candidates_.empty()) return result;
  // Where the curve is expected comes first: another motion has to be better.
  Motion best = Motion::Zero();
  double best_score = score(candidates, best);
  robust::Draws draws;
  const Eigen::Matrix4d known = information(range);
  for (int h = 0; h < kHypotheses && best_score < kEnough * most_; ++h) {
    Eigen::Matrix4d normal = known;
    Motion right = Motion::Zero();
    for (int k = 0; k < kDraw; ++k) {
      const std::size_t i = static_cast<std::size_t>(with_candidates_[draws.below(with_candidates_.size())]);
      const WeightedCandidates& all = candidates[i];
      const std::size_t count = static_cast<std::size_t>(all.found.count);
      std::size_t at = draws.below(count);
      while (!(all.weight[at] > 0.0f)) at = (at + 1) % count;
      normal += rows_[i] * rows_[i].transpose() / (kNoise * kNoise);
      right += rows_[i] * static_cast<double>(all.found.at[at].offset) / (kNoise * kNoise);
    }
    const Motion motion = normal.ldlt().solve(right);
    const double value = score(candidates, motion);
    if (value > best_score) {
      best_score = value;
      best = motion;
    }
  }
  for (int k = 0; k < 2; ++k) {
    const Motion motion = refined(candidates, best, range);
    const double value = score(candidates, motion);
    if (!(value > best_score)) break;
    best_score = value;
    best = motion;
  }
  result.score = best_score;
  result.share = best_score / most_;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!sites[i].probe) result.largest = robust::largest(result.largest, std::abs(rows_[i].dot(best)));
  }
  const double grow = 1.0 + best[2] / radius_, turn = best[3] / radius_;
  result.motion.topLeftCorner<2, 2>() << grow, -turn, turn, grow;
  result.motion.topRightCorner<2, 1>() = centre_ + best.head<2>() - result.motion.topLeftCorner<2, 2>() * centre_;
  return result;
}

}  // namespace laparoscope_servo::features
