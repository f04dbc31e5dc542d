#include "features/points/point_motion.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "laparoscope_servo/robust/median.h"
#include "laparoscope_servo/robust/weights.h"

namespace laparoscope_servo::features {

namespace {

constexpr int kUnknowns = 4;         // growth, turn, shift x and y
constexpr double kUnit = 100.0;      // px: growth and turn are told as motions at this distance
constexpr double kLeastSigma = 0.3;  // px: tissue that deforms is no similarity
constexpr std::size_t kProposals = 40;
constexpr std::size_t kFewestToPropose = 5;  // fewer points have no majority
constexpr double kLeastApart = 20.0;         // px: points nearer together do not tell growth and turn
// px at kUnit, standard deviation of growth and turn before anything is known: it counts for very few points only.
constexpr double kSpread = 50.0;

constexpr double kAgrees = 0.25;  // weight: within 3.3 standard deviations

robust::Row row(double growth, double turn, int axis, double moved) {
  robust::Row result;
  result.count = kUnknowns;
  result.a[0] = growth / kUnit;
  result.a[1] = turn / kUnit;
  result.a[static_cast<std::size_t>(2 + axis)] = 1.0;
  result.b = moved;
  return result;
}

}  // namespace

void PointMotion::reserve(int points) {
  from_.reserve(static_cast<std::size_t>(points));
  to_.reserve(static_cast<std::size_t>(points));
  rows_.reserve(2 * static_cast<std::size_t>(points));
  scratch_.reserve(static_cast<std::size_t>(points));
  irls_.reserve(kUnknowns, 2 * points);
  information_ = Eigen::MatrixXd::Zero(kUnknowns, kUnknowns);
  information_(0, 0) = information_(1, 1) = 1.0 / (kSpread * kSpread);
}

void PointMotion::clear() {
  from_.clear();
  to_.clear();
}

void PointMotion::add(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  from_.push_back(from);
  to_.push_back(to);
}

// Least squares take what several points astray agree on for the motion's; a similarity through two points that leaves
// little at half of the others does not. Pairs are far apart in the order of the points.
void PointMotion::propose() {
  const std::size_t count = from_.size(), step = std::max<std::size_t>(1, count / kProposals);
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < count; k += step) {
    for (const std::size_t apart : {count / 2, count / 3 + 1}) {
      const std::size_t other = (k + apart) % count;
      const Eigen::Vector2d a = from_[other] - from_[k], b = to_[other] - to_[k];
      const double square = a.squaredNorm();
      if (!(square > kLeastApart * kLeastApart)) continue;
      const double growth = a.dot(b) / square, turn = (a.x() * b.y() - a.y() * b.x()) / square;
      Eigen::Matrix2d linear;
      linear << growth, -turn, turn, growth;
      scratch_.clear();
      for (std::size_t i = 0; i < count; ++i)
        scratch_.push_back((to_[i] - to_[k] - linear * (from_[i] - from_[k])).squaredNorm());
      const double median = robust::median(scratch_);
      if (!(median < best)) continue;
      best = median;
      linear_ = linear;
      shift_ = to_[k] - centre_ - linear * (from_[k] - centre_);
    }
  }
}

// What the proposal leaves is fitted, from the points next to it on.
bool PointMotion::fit() {
  centre_.setZero();
  shift_.setZero();
  linear_.setIdentity();
  if (from_.empty()) return false;
  for (const Eigen::Vector2d& p : from_) centre_ += p / static_cast<double>(from_.size());
  if (from_.size() >= kFewestToPropose) propose();
  rows_.clear();
  for (std::size_t k = 0; k < from_.size(); ++k) {
    const Eigen::Vector2d p = from_[k] - centre_, left = to_[k] - similarity(from_[k]);
    rows_.push_back(row(p.x(), -p.y(), 0, left.x()));
    rows_.push_back(row(p.y(), p.x(), 1, left.y()));
  }
  robust::IrlsConfig config;
  config.min_sigma = kLeastSigma;
  config.min_step = 1e-3;
  const robust::IrlsResult solved = irls_.solve(kUnknowns, rows_, config, information_);
  if (!solved.solved) return false;
  const Eigen::VectorXd& x = irls_.x();
  Eigen::Matrix2d further;
  further << x[0] / kUnit, -x[1] / kUnit, x[1] / kUnit, x[0] / kUnit;
  linear_ += further;
  shift_ += x.tail<2>();
  sigma_ = solved.sigma;
  return true;
}

// Tissue deforms: what differs a little more than most do is not astray for that.
double PointMotion::weight(std::size_t k) const {
  return robust::tukeyWeight((to_[k] - similarity(from_[k])).norm() / std::max(sigma_, deformation_));
}

bool PointMotion::agrees(int k) const {
  return weight(static_cast<std::size_t>(k)) > kAgrees;
}

// The neighbours that agree tell what the similarity does not.
Eigen::Vector2d PointMotion::apply(const Eigen::Vector2d& p) const {
  Eigen::Vector2d rest = Eigen::Vector2d::Zero();
  double total = 1.0;  // as of a neighbour at p for which the similarity holds
  for (std::size_t k = 0; k < from_.size(); ++k) {
    const double near = 1.0 + (from_[k] - p).squaredNorm() / (reach_ * reach_), say = weight(k) / (near * near);
    rest += say * (to_[k] - similarity(from_[k]));
    total += say;
  }
  return similarity(p) + rest / total;
}

}  // namespace laparoscope_servo::features
