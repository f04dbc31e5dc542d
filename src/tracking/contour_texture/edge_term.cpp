#include "tracking/contour_texture/edge_term.h"

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/features/edge_verdict.h"
#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/geometry/sl3.h"
#include "laparoscope_servo/robust/median.h"
#include "laparoscope_servo/robust/scale.h"
#include "laparoscope_servo/robust/weights.h"

namespace laparoscope_servo::tracking {

namespace {

using features::EdgeLooks;
using features::Site;

constexpr double kLearnRange = 3.0;   // px: the contour was fitted to its edges
constexpr double kCoarse = 10.0;      // px: from such a range on every other sample is looked at
constexpr double kMinSigma = 0.2;     // px: what sampling, and a contour that is no plane's, leave
constexpr double kGainChange = 0.1;   // standard deviation of the light's gain, from image to image
constexpr double kBiasChange = 20.0;  // grey levels, of its bias
constexpr double kManyLost = 0.1;     // share of the sites that agree, without which the fit is another one
constexpr float kLearn = 0.2f;        // share of the looks that a new image adds to what is remembered

}  // namespace

void EdgeTerm::learn(const cv::Mat& image, const Outline& outline) {
  outline_ = outline;
  memory_.reset(Outline::kSlots, Outline::kSlots / 50);
  const std::size_t most = Outline::kSlots;
  sites_.reserve(most);
  candidates_.resize(most);
  association_.reserve(Outline::kSlots, most);
  for (auto* values : {&moved_, &errors_, &weights_}) values->reserve(most);
  equations_.reserve(most);
  coarse_.reserve(Outline::kSlots);
  look(image, Eigen::Matrix3d::Identity(), kLearnRange, config_.max_sites);
  choose(Eigen::Matrix3d::Identity());
  for (std::size_t row = 0; row < association_.rows().size(); ++row) {
    const std::size_t site = association_.siteOf(row);
    memory_.learn(sites_[site].slot, association_.looks(site), 1.0f);
  }
}

void EdgeTerm::look(const cv::Mat& image, const Eigen::Matrix3d& g, double range, int most) {
  range_ = range;
  outline_.sites(g, config_.spacing, std::min(most, config_.max_sites), sites_);
  const bool coarse = range >= kCoarse;
  const features::EdgeWindow window{range, coarse ? 2.0 : 1.0, coarse ? 2 : 1};
  int matching = 0, looking = 0;
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    features::WeightedCandidates& candidates = candidates_[i];
    search_.find(image, sites_[i], window, config_.min_contrast, candidates.found);
    looking += candidates.found.inside ? 1 : 0;
    const EdgeLooks* memory = candidates.found.count > 0 ? memory_.find(sites_[i].slot) : nullptr;
    for (int k = 0; k < candidates.found.count; ++k) {
      const std::size_t at = static_cast<std::size_t>(k);
      const EdgeLooks& looks = candidates.found.at[at].looks;
      const float contrast = std::abs(looks.contrast);
      candidates.weight[at] = memory != nullptr
                                  ? features::similarity(looks, *memory, static_cast<float>(config_.min_similarity))
                                  : contrast / (contrast + 4.0f * static_cast<float>(config_.min_contrast));
      matching += candidates.found.inside && candidates.weight[at] > 0.0f ? 1 : 0;
    }
  }
  matching_ = looking > 0 ? static_cast<double>(matching) / looking : 0.0;
}

void EdgeTerm::choose(const Eigen::Matrix3d& g) {
  moved_.clear();
  for (const Site& site : sites_) moved_.push_back(movedFrom(site, g));
  association_.choose(sites_, candidates_, range_, moved_);
  errors_.clear();
  for (const robust::Row& row : association_.rows()) {
    if (row.weight > 0.0) errors_.push_back(std::abs(row.b));
  }
  sigma_ = scaleOf(errors_);
  weights_.clear();
  for (const robust::Row& row : association_.rows()) weights_.push_back(robust::tukeyWeight(row.b / sigma_));  // (12)
}

double EdgeTerm::movedFrom(const Site& site, const Eigen::Matrix3d& g) const {
  return site.normal.dot(geometry::apply(g, outline_.point(site.slot)) - site.point);
}

double EdgeTerm::scaleOf(std::vector<double>& magnitudes) {
  if (magnitudes.empty()) return kMinSigma;
  return std::max(kMinSigma, robust::kMadToSigma * robust::median(magnitudes));  // (13), about 0
}

// As choose(), but for what only gate() asks for: this is called in every iteration.
void EdgeTerm::add(const Eigen::Matrix3d& g, double gain, Matrix10d& information, Vector10d& score) {
  equations_.clear();
  errors_.clear();
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    if (association_.isLonely(sites_[i].slot)) continue;
    const double moved = movedFrom(sites_[i], g);
    const int best = features::bestOf(candidates_[i], range_, moved);
    if (best < 0) continue;
    const double away = static_cast<double>(candidates_[i].found.at[static_cast<std::size_t>(best)].offset) - moved;
    equations_.push_back({i, away});
    errors_.push_back(std::abs(away));
  }
  sigma_ = scaleOf(errors_);
  // Edges err alike over some length of the contour, which sites that are taken for independent do not know.
  const double spacing = outline_.length() / static_cast<double>(std::max<std::size_t>(1, sites_.size()));
  const double unit = 1.0 / (sigma_ * sigma_ * features::correlation(spacing));
  Matrix8d sum = Matrix8d::Zero();
  geometry::Vector8d right = geometry::Vector8d::Zero();
  for (const Equation& equation : equations_) {
    const double weight = unit * robust::tukeyWeight(equation.away / sigma_);  // (12)
    if (!(weight > 0.0)) continue;
    const Eigen::Map<const geometry::Vector8d> row(sites_[equation.site].jacobian.data());
    const geometry::Vector8d scaled = weight * row;
    sum.noalias() += scaled * row.transpose();
    right += equation.away * scaled;
  }
  information.topLeftCorner<8, 8>() += sum;
  score.head<8>() -= right;
  information(8, 8) += 1.0 / (kGainChange * kGainChange);
  score[8] += (gain - expected_gain_) / (kGainChange * kGainChange);
  information(9, 9) += 1.0 / (kBiasChange * kBiasChange);
}

bool EdgeTerm::gate(const Eigen::Matrix3d& g) {
  choose(g);
  // Of the sites that had a say.
  const auto agreeing = [&] {
    int count = 0;
    for (std::size_t row = 0; row < association_.rows().size(); ++row) {
      const bool agrees = findings()[association_.siteOf(row)].weight >= features::kAgreeWeight;
      count += association_.rows()[row].weight > 0.0 && agrees ? 1 : 0;
    }
    return count;
  };
  association_.settle(sites_, no_step_, weights_, sigma_);
  const int before = agreeing();
  association_.dropLonely(sites_, matching_, range_);
  return static_cast<double>(before - agreeing()) > kManyLost * static_cast<double>(before);
}

features::EdgeReport EdgeTerm::judge(const Matrix8d& covariance, double min_share) {
  features::EdgeReport report;
  report.reason = features::Reason::kNone;
  report.sigma = sigma_;
  covariance_ = covariance;
  features::judge({sites_, findings(), covariance_, 8, false, range_, matching_}, config_, min_share, report);
  return report;
}

void EdgeTerm::remember() {
  for (std::size_t i = 0; i < findings().size(); ++i) {
    if (findings()[i].weight >= features::kAgreeWeight) memory_.learn(sites_[i].slot, association_.looks(i), kLearn);
  }
}

}  // namespace laparoscope_servo::tracking
