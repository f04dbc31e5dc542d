#include "tracking/contour_texture/edge_term.h"

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/features/edge_association.h"
#include "laparoscope_servo/features/edge_verdict.h"
#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/geometry/sl3.h"
#include "laparoscope_servo/robust/median.h"
#include "laparoscope_servo/robust/scale.h"
#include "laparoscope_servo/robust/weights.h"

namespace laparoscope_servo::tracking {

namespace {

using features::EdgeCandidate;
using features::EdgeLooks;
using features::Site;

constexpr double kLearnRange = 3.0;   // px: the contour was fitted to its edges
constexpr double kCoarse = 10.0;      // px: from such a range on every other sample is looked at
constexpr double kMinSigma = 0.2;     // px: what sampling, and a contour that is no plane's, leave
constexpr double kGainChange = 0.1;   // standard deviation of the light's gain, from image to image
constexpr double kBiasChange = 20.0;  // grey levels, of its bias
constexpr float kLearn = 0.2f;        // share of the looks that a new image adds to what is remembered

}  // namespace

void EdgeTerm::learn(const cv::Mat& image, const Outline& outline) {
  outline_ = outline;
  memory_.reset(Outline::kSlots, Outline::kSlots / 50);
  const std::size_t most = Outline::kSlots;
  for (auto* sites : {&sites_, &moved_}) sites->reserve(most);
  candidates_.resize(most);
  chosen_.reserve(most);
  errors_.reserve(most);
  findings_.reserve(most);
  coarse_.reserve(Outline::kSlots);
  look(image, Eigen::Matrix3d::Identity(), kLearnRange, config_.max_sites);
  choose(Eigen::Matrix3d::Identity());
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    if (chosen_[i].candidate < 0) continue;
    memory_.learn(sites_[i].slot, candidates_[i].found.at[static_cast<std::size_t>(chosen_[i].candidate)].looks, 1.0f);
  }
}

void EdgeTerm::look(const cv::Mat& image, const Eigen::Matrix3d& g, double range, int most) {
  range_ = range;
  outline_.sites(g, config_.spacing, std::min(most, config_.max_sites), sites_);
  const bool coarse = range >= kCoarse;
  const features::EdgeWindow window{range, coarse ? 2.0 : 1.0, coarse ? 2 : 1};
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    features::WeightedCandidates& candidates = candidates_[i];
    search_.find(image, sites_[i], window, config_.min_contrast, candidates.found);
    const EdgeLooks* memory = candidates.found.count > 0 ? memory_.find(sites_[i].slot) : nullptr;
    for (int k = 0; k < candidates.found.count; ++k) {
      const std::size_t at = static_cast<std::size_t>(k);
      const EdgeLooks& looks = candidates.found.at[at].looks;
      const float contrast = std::abs(looks.contrast);
      candidates.weight[at] = memory != nullptr
                                  ? features::similarity(looks, *memory, static_cast<float>(config_.min_similarity))
                                  : contrast / (contrast + 4.0f * static_cast<float>(config_.min_contrast));
    }
  }
}

void EdgeTerm::choose(const Eigen::Matrix3d& g) {
  chosen_.assign(sites_.size(), {});
  errors_.clear();
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    const Site& site = sites_[i];
    const double moved = site.normal.dot(geometry::apply(g, outline_.point(site.slot)) - site.point);
    double best = 0.0;
    for (int k = 0; k < candidates_[i].found.count; ++k) {
      const std::size_t at = static_cast<std::size_t>(k);
      const double error = static_cast<double>(candidates_[i].found.at[at].offset) - moved;
      const double t = error / (range_ + 1.0);
      const double value = static_cast<double>(candidates_[i].weight[at]) * (1.0 - t * t);
      if (!(value > best)) continue;
      best = value;
      chosen_[i].candidate = k;
      chosen_[i].error = error;
    }
    if (chosen_[i].candidate >= 0) errors_.push_back(std::abs(chosen_[i].error));
  }
  sigma_ = errors_.empty() ? kMinSigma
                           : std::max(kMinSigma, robust::kMadToSigma * robust::median(errors_));  // (13), about 0
  for (Chosen& chosen : chosen_) {
    if (chosen.candidate >= 0) chosen.weight = robust::tukeyWeight(chosen.error / sigma_);  // (12)
  }
}

void EdgeTerm::add(const Eigen::Matrix3d& g, double gain, Matrix10d& information, Vector10d& score) {
  choose(g);
  // Edges err alike over some length of the contour, which sites that are taken for independent do not know.
  const double spacing = outline_.length() / static_cast<double>(std::max<std::size_t>(1, sites_.size()));
  const double unit = 1.0 / (sigma_ * sigma_ * features::correlation(spacing));
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    if (!(chosen_[i].weight > 0.0)) continue;
    const Eigen::Map<const geometry::Vector8d> row(sites_[i].jacobian.data());
    information.topLeftCorner<8, 8>().noalias() += unit * chosen_[i].weight * row * row.transpose();
    score.head<8>() -= unit * chosen_[i].weight * chosen_[i].error * row;
  }
  information(8, 8) += 1.0 / (kGainChange * kGainChange);
  score[8] += (gain - expected_gain_) / (kGainChange * kGainChange);
  information(9, 9) += 1.0 / (kBiasChange * kBiasChange);
}

features::EdgeReport EdgeTerm::judge(const Eigen::Matrix3d& g, const Matrix8d& covariance, double min_share) {
  choose(g);
  findings_.clear();
  int matching = 0, looking = 0;
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    const Chosen& chosen = chosen_[i];
    const Eigen::Vector2d point = geometry::apply(g, outline_.point(sites_[i].slot));
    const double error = std::abs(chosen.error);
    const bool near = chosen.candidate >= 0 && error < std::max(features::kAgreeDistance, 2.0 * sigma_) &&
                      error < 2.0 * features::kAgreeDistance;
    findings_.push_back({point, chosen.candidate >= 0 ? point + chosen.error * sites_[i].normal : point,
                         near ? chosen.weight : 0.0, candidates_[i].found.inside, false, sites_[i].slot});
    if (!candidates_[i].found.inside) continue;
    ++looking;
    for (int k = 0; k < candidates_[i].found.count; ++k) {
      matching += candidates_[i].weight[static_cast<std::size_t>(k)] > 0.0f ? 1 : 0;
    }
  }
  features::EdgeReport report;
  report.reason = features::Reason::kNone;
  report.sigma = sigma_;
  covariance_ = covariance;
  const double per_site = looking > 0 ? static_cast<double>(matching) / looking : 0.0;
  features::judge({sites_, findings_, covariance_, 8, false, range_, per_site}, config_, min_share, report);
  return report;
}

void EdgeTerm::remember() {
  for (std::size_t i = 0; i < findings_.size(); ++i) {
    if (findings_[i].weight < features::kAgreeWeight) continue;
    memory_.learn(sites_[i].slot, candidates_[i].found.at[static_cast<std::size_t>(chosen_[i].candidate)].looks,
                  kLearn);
  }
}

}  // namespace laparoscope_servo::tracking
