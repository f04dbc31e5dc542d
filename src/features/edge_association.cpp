#include "laparoscope_servo/features/edge_association.h"

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/robust/largest.h"

namespace laparoscope_servo::features {

namespace {

// Neighbours either side along the curve, and the share of them that has to agree: without stray edges, and at most.
constexpr int kNeighbours = 4;
constexpr double kLeastNeighbours = 0.33;
constexpr double kMostNeighbours = 0.7;

}  // namespace

int bestOf(const WeightedCandidates& candidates, double range, double moved) {
  int best = -1;
  double best_value = 0.0;
  for (int k = 0; k < candidates.found.count; ++k) {
    const std::size_t at = static_cast<std::size_t>(k);
    const double t = (static_cast<double>(candidates.found.at[at].offset) - moved) / (range + 1.0);
    const double value = static_cast<double>(candidates.weight[at]) * (1.0 - t * t);
    if (value > best_value) {
      best_value = value;
      best = k;
    }
  }
  return best;
}

double displacement(const Site& site, const Eigen::VectorXd& step) {
  double sum = 0.0;
  for (int k = 0; k < site.count; ++k)
    sum += site.jacobian[static_cast<std::size_t>(k)] * step[robust::columnOf(site.first, k, step.size())];
  return sum;
}

void EdgeAssociation::reserve(int slots, std::size_t sites) {
  lonely_.assign(static_cast<std::size_t>(slots), false);
  findings_.reserve(sites);
  looks_.resize(sites);
  rows_.reserve(sites);
  row_site_.reserve(sites);
  seen_.reserve(2 * (sites + 1));
}

void EdgeAssociation::forgetLonely() {
  std::fill(lonely_.begin(), lonely_.end(), false);
}

void EdgeAssociation::choose(const std::vector<Site>& sites, const std::vector<WeightedCandidates>& candidates,
                             double range, const std::vector<double>& moved) {
  findings_.resize(sites.size());
  rows_.clear();
  row_site_.clear();
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Site& site = sites[i];
    const EdgeCandidates& found = candidates[i].found;
    const double left = moved.empty() ? 0.0 : moved[i];
    const Eigen::Vector2d point = site.point + left * site.normal;
    findings_[i] = {point, point, 0.0, found.inside, site.probe, site.slot};
    const int best = bestOf(candidates[i], range, left);
    if (best < 0) continue;
    const EdgeCandidate& candidate = found.at[static_cast<std::size_t>(best)];
    looks_[i] = candidate.looks;
    findings_[i].edge = site.point + static_cast<double>(candidate.offset) * site.normal;
    robust::Row row;
    row.first = site.first;
    row.count = site.count;
    row.a = site.jacobian;
    row.b = static_cast<double>(candidate.offset) - left;
    row.weight = site.probe || isLonely(site.slot) ? 0.0 : 1.0;
    rows_.push_back(row);
    row_site_.push_back(i);
  }
}

double EdgeAssociation::settle(const std::vector<Site>& sites, const Eigen::VectorXd& step,
                               const std::vector<double>& weights, double sigma) {
  double largest = 0.0;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const double moved = displacement(sites[i], step);
    if (!sites[i].probe) largest = robust::largest(largest, std::abs(moved));
    findings_[i].point += moved * sites[i].normal;
  }
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const std::size_t i = row_site_[r];
    const double error = std::abs(rows_[r].b - displacement(sites[i], step));
    const bool near = error < std::max(kAgreeDistance, 2.0 * sigma) && error < 2.0 * kAgreeDistance;
    findings_[i].weight = near ? std::max(weights[r], 0.0) : 0.0;
  }
  return largest;
}

bool EdgeAssociation::dropLonely(const std::vector<Site>& sites, double stray, double range) {
  const double chance = std::clamp((stray - 1.0) * 2.0 * kAgreeDistance / range, 0.0, 1.0);
  const double least = std::clamp(kLeastNeighbours + chance, kLeastNeighbours, kMostNeighbours);
  const int count = static_cast<int>(findings_.size());
  seen_.assign(static_cast<std::size_t>(2 * (count + 1)), 0);
  for (int i = 0; i < count; ++i) {
    const SiteFinding& finding = findings_[static_cast<std::size_t>(i)];
    const bool counts = finding.inside && !finding.probe;
    seen_[static_cast<std::size_t>(2 * i + 2)] =
        seen_[static_cast<std::size_t>(2 * i)] + (counts && finding.weight >= kAgreeWeight ? 1 : 0);
    seen_[static_cast<std::size_t>(2 * i + 3)] = seen_[static_cast<std::size_t>(2 * i + 1)] + (counts ? 1 : 0);
  }
  bool changed = false;
  for (int i = 0; i < count; ++i) {
    SiteFinding& finding = findings_[static_cast<std::size_t>(i)];
    if (finding.probe) continue;
    const int from = std::max(0, std::min(i - kNeighbours, count - 1 - 2 * kNeighbours));
    const int to = std::min(count, std::max(i + kNeighbours, 2 * kNeighbours) + 1);
    const int agree = seen_[static_cast<std::size_t>(2 * to)] - seen_[static_cast<std::size_t>(2 * from)];
    const int inside = seen_[static_cast<std::size_t>(2 * to + 1)] - seen_[static_cast<std::size_t>(2 * from + 1)];
    char& lonely = lonely_[static_cast<std::size_t>(sites[static_cast<std::size_t>(i)].slot)];
    const bool is_lonely = !(agree >= least * inside);
    changed = changed || (finding.weight > 0.0 && is_lonely != static_cast<bool>(lonely));
    lonely = is_lonely;
    if (is_lonely) finding.weight = 0.0;
  }
  return changed;
}

}  // namespace laparoscope_servo::features
