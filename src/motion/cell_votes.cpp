#include "motion/cell_votes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "laparoscope_servo/robust/draws.h"

namespace laparoscope_servo::motion {

namespace {

using geometry::Vector8d;
using tracking::Matrix8d;

constexpr int kMostVotes = 200;
constexpr int kFewest = 12;           // votes
constexpr double kMostStddev = 0.25;  // px of the level, of a vote in its worst direction
constexpr double kFar = 1.5;          // px of the level: a longer shift is no vote, since its equations are linear
constexpr double kTolerance = 0.4;    // px of the level: votes that agree differ by less
constexpr int kDraws = 160;           // of four: with 60 % of the votes right one of eight is
constexpr int kRefinements = 4;
constexpr double kSingular = 1e-6;  // see tracking::Factors::conditioning

// Solves for the first `unknowns` of a; false when they are not determined.
bool solve(Matrix8d normal, Vector8d right, int unknowns, Vector8d& a) {
  const int without = 8 - unknowns;
  normal.rightCols(without).setZero();
  normal.bottomRows(without).setZero();
  normal.diagonal().tail(without).setOnes();
  right.tail(without).setZero();
  const tracking::Factors<8> factors(normal);
  if (!(factors.conditioning() > kSingular)) return false;
  a = factors.solve(right);
  return a.allFinite();
}

}  // namespace

// About the means, so that an offset of the light is no motion. The sums are of the gradients of image and reference
// added, twice their mean.
CellShift shiftOf(const tracking::CellSums& cell) {
  const double w = std::max(1e-6, static_cast<double>(cell.w));
  const double x = static_cast<double>(cell.x), y = static_cast<double>(cell.y), r = static_cast<double>(cell.r);
  CellShift shift;
  shift.matrix(0, 0) = (static_cast<double>(cell.xx) - x * x / w) / 4.0;
  shift.matrix(0, 1) = shift.matrix(1, 0) = (static_cast<double>(cell.xy) - x * y / w) / 4.0;
  shift.matrix(1, 1) = (static_cast<double>(cell.yy) - y * y / w) / 4.0;
  shift.vector << -(static_cast<double>(cell.xr) - x * r / w) / 2.0, -(static_cast<double>(cell.yr) - y * r / w) / 2.0;
  return shift;
}

void CellVotes::gather(const tracking::EsmLevel& level, const std::vector<tracking::CellSums>& cells, double sigma) {
  votes_.clear();
  const int columns = level.weight.strips() * level.cells_per_strip;
  const int width = image::Patch::kStrip / level.cells_per_strip;
  const int across = (level.width + width - 1) / width, down = (level.height + level.cell_rows - 1) / level.cell_rows;
  votes_.reserve(static_cast<std::size_t>(across * down));
  const Eigen::Vector2d centre(0.5 * (level.width - 1), 0.5 * (level.height - 1));
  for (int j = 0; j < down; ++j) {
    for (int i = 0; i < across; ++i) {
      const CellShift cell = shiftOf(cells[static_cast<std::size_t>(j * columns + i)]);
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
      solver.computeDirect(cell.matrix);
      if (!(sigma < kMostStddev * std::sqrt(std::max(0.0, solver.eigenvalues()[0])))) continue;
      const Eigen::Vector2d shift = cell.matrix.inverse() * cell.vector;
      if (!(shift.norm() < kFar)) continue;
      const Eigen::Vector2d at(i * width + 0.5 * (width - 1), j * level.cell_rows + 0.5 * (level.cell_rows - 1));
      votes_.push_back({fieldJacobian(level.scale * (at - centre)), level.scale * shift});
    }
  }
  // Keeps every n-th vote, all over the image.
  const std::size_t every = votes_.size() / kMostVotes + 1;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < votes_.size(); k += every) votes_[kept++] = votes_[k];
  votes_.resize(kept);
}

double CellVotes::agreement(const Vector8d& a, double tolerance) const {
  double sum = 0.0;
  for (const Vote& vote : votes_) {
    const double squared = (vote.shift - vote.jacobian * a).squaredNorm() / (tolerance * tolerance);
    sum += std::max(0.0, 1.0 - squared);
  }
  return sum;
}

// The motion of as many votes as determine it, on which most others agree.
std::optional<Vector8d> CellVotes::drawn(int unknowns, double tolerance) const {
  std::optional<Vector8d> best;
  double most = 0.0;
  robust::Draws draws;
  const int count = unknowns / 2;
  for (int k = 0; k < kDraws; ++k) {
    Matrix8d normal = Matrix8d::Zero();
    Vector8d right = Vector8d::Zero(), a;
    for (int i = 0; i < count; ++i) {
      const Vote& vote = votes_[draws.below(votes_.size())];
      normal += vote.jacobian.transpose() * vote.jacobian;
      right += vote.jacobian.transpose() * vote.shift;
    }
    if (!solve(normal, right, unknowns, a)) continue;
    const double sum = agreement(a, tolerance);
    if (!(sum > most)) continue;
    most = sum;
    best = a;
  }
  return best;
}

bool CellVotes::refine(Vector8d& a, int unknowns, double tolerance) const {
  Matrix8d normal = Matrix8d::Zero();
  Vector8d right = Vector8d::Zero();
  for (const Vote& vote : votes_) {
    const double squared = (vote.shift - vote.jacobian * a).squaredNorm() / (tolerance * tolerance);
    const double weight = squared < 1.0 ? (1.0 - squared) * (1.0 - squared) : 0.0;
    if (!(weight > 0.0)) continue;
    normal += weight * vote.jacobian.transpose() * vote.jacobian;
    right += weight * vote.jacobian.transpose() * vote.shift;
  }
  return solve(normal, right, unknowns, a);
}

std::optional<Vector8d> CellVotes::fit(const tracking::EsmLevel& level, const std::vector<tracking::CellSums>& cells,
                                       double sigma, Model model) {
  gather(level, cells, sigma);
  if (static_cast<int>(votes_.size()) < kFewest) return std::nullopt;
  const int unknowns = parametersOf(model);
  const double tolerance = kTolerance * level.scale;
  std::optional<Vector8d> a = drawn(unknowns, tolerance);
  for (int k = 0; a && k < kRefinements; ++k) {
    if (!refine(*a, unknowns, tolerance)) return std::nullopt;
  }
  return a;
}

}  // namespace laparoscope_servo::motion
