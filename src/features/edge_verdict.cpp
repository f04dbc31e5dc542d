#include "laparoscope_servo/features/edge_verdict.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "features/chance.h"
#include "laparoscope_servo/features/edge_association.h"
#include "laparoscope_servo/robust/irls.h"
#include "laparoscope_servo/robust/largest.h"

namespace laparoscope_servo::features {

namespace {

// px: edges of a straight thing spread less about its line. What is gathered from a texture spreads more: where less
// than kMostlySeen of the sites agree, less is allowed.
constexpr double kMaxSigma = 1.5;
constexpr double kMaxSigmaOfFew = 0.7;
constexpr double kMostlySeen = 0.6;
constexpr int kLeastSites = 8;
constexpr double kCorrelation = 8.0;  // px along the curve, over which edges err alike
// px: within each of them the agreement is compared with chance. Of edges that are not the curve's as many lie in one
// part of kAgreeDistance as in another, while the curve's own are nearer.
constexpr double kTolerances[] = {kAgreeDistance, 0.5 * kAgreeDistance, 0.25 * kAgreeDistance};

// px^2, of the curve's displacement along the site's normal: J C J', C being symmetric.
double variance(const Site& site, const Eigen::MatrixXd& covariance) {
  std::array<Eigen::Index, Site::kMostCoefficients> column{};
  double sum = 0.0;
  for (int k = 0; k < site.count; ++k) {
    const std::size_t i = static_cast<std::size_t>(k);
    column[i] = robust::columnOf(site.first, k, covariance.rows());
    double row = 0.5 * site.jacobian[i] * covariance(column[i], column[i]);
    for (std::size_t l = 0; l < i; ++l) row += site.jacobian[l] * covariance(column[l], column[i]);
    sum += 2.0 * site.jacobian[i] * row;
  }
  return sum;
}

// The most for any of the tolerances. Each gives a bound of the probability; the smallest of three bounds, times three,
// is one, too.
double mostEvidence(const FitOutcome& fit, Agreement agreement) {
  double most = 0.0;
  for (const double tolerance : kTolerances) {
    agreement.tolerance = tolerance;
    agreement.agree = static_cast<int>(
        std::count_if(fit.findings.begin(), fit.findings.end(), [tolerance](const SiteFinding& finding) {
          return !finding.probe && finding.inside && finding.weight >= kAgreeWeight &&
                 (finding.edge - finding.point).norm() <= tolerance;
        }));
    most = std::max(most, evidence(agreement) - std::log(static_cast<double>(std::size(kTolerances))));
  }
  return most;
}

}  // namespace

double correlation(double spacing) {
  return std::max(1.0, kCorrelation / spacing);
}

void judge(const FitOutcome& fit, const EdgeConfig& config, double min_share, EdgeReport& report) {
  double worst = 0.0;
  for (std::size_t i = 0; i < fit.sites.size(); ++i) {
    if (fit.sites[i].probe) continue;
    const bool agrees = fit.findings[i].inside && fit.findings[i].weight >= kAgreeWeight;
    if (agrees || !fit.deforms) worst = robust::largest(worst, variance(fit.sites[i], fit.covariance));
    report.inside += fit.findings[i].inside ? 1 : 0;
    report.used += agrees ? 1 : 0;
  }
  report.share = report.inside > 0 ? static_cast<double>(report.used) / report.inside : 0.0;
  report.expected_error = std::sqrt(worst);
  Agreement agreement;
  agreement.sites = report.inside;
  agreement.agree = report.used;
  agreement.tolerance = kAgreeDistance;
  agreement.strays = std::max(0.0, fit.matching - report.share);
  agreement.range = fit.range;
  agreement.freedoms = fit.parameters;
  agreement.independent = std::min(1.0, config.spacing / kCorrelation);
  report.evidence = mostEvidence(fit, agreement);
  if (report.inside < kLeastSites) {
    report.reason = Reason::kOutside;
  } else if (!(report.share >= min_share) || report.used < kLeastSites) {
    report.reason = Reason::kTooFewSites;
  } else if (!(report.sigma <= (report.share < kMostlySeen ? kMaxSigmaOfFew : kMaxSigma)) || !isNoChance(agreement)) {
    report.reason = Reason::kChance;
  } else if (!(report.expected_error <= config.max_error)) {
    report.reason = Reason::kUncertain;
  }
}

}  // namespace laparoscope_servo::features
