#include "laparoscope_servo/features/edge_verdict.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::features {
namespace {

// A fit of a curve of one parameter, of which `used` of `inside` sites agree.
EdgeReport judged(int inside, int used, double sigma, double variance = 0.01, double matching = 1.0, int outside = 0) {
  std::vector<Site> sites(static_cast<std::size_t>(inside + outside));
  std::vector<SiteFinding> findings(sites.size());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    sites[i].count = 1;
    sites[i].jacobian[0] = 2.0;
    findings[i].inside = static_cast<int>(i) < inside;
    findings[i].weight = static_cast<int>(i) < used ? 1.0 : 0.0;
  }
  EdgeReport report;
  report.reason = Reason::kNone;
  report.sigma = sigma;
  const Eigen::MatrixXd covariance = Eigen::MatrixXd::Constant(1, 1, variance);
  judge({sites, findings, covariance, 1, false, 20.0, matching}, EdgeConfig(), 0.3, report);
  return report;
}

TEST(EdgeVerdict, countsSitesInTheImage) {
  const EdgeReport report = judged(50, 40, 0.2, 0.01, 1.0, 30);
  EXPECT_EQ(report.reason, Reason::kNone);
  EXPECT_EQ(report.inside, 50);
  EXPECT_EQ(report.used, 40);
  EXPECT_DOUBLE_EQ(report.share, 0.8);
  EXPECT_DOUBLE_EQ(report.expected_error, 0.2);
}

TEST(EdgeVerdict, saysWhyAFitIsNotBelieved) {
  EXPECT_EQ(judged(7, 7, 0.2).reason, Reason::kOutside);
  EXPECT_EQ(judged(50, 14, 0.2).reason, Reason::kTooFewSites);
  EXPECT_EQ(judged(20, 7, 0.2).reason, Reason::kTooFewSites);
  EXPECT_EQ(judged(50, 40, 1.6).reason, Reason::kChance);
  EXPECT_EQ(judged(50, 25, 0.8).reason, Reason::kChance);  // where few agree they have to agree better
  EXPECT_EQ(judged(50, 20, 0.2, 0.01, 6.0).reason, Reason::kChance);
  EXPECT_EQ(judged(50, 40, 0.2, 1.0).reason, Reason::kUncertain);
  EXPECT_EQ(judged(50, 40, 0.2, std::nan("")).reason, Reason::kUncertain);
}

// What is not seen of a curve that deforms is not claimed.
TEST(EdgeVerdict, theErrorOfACurveThatDeformsIsThatOfWhatIsSeen) {
  std::vector<Site> sites(40);
  std::vector<SiteFinding> findings(sites.size());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    sites[i].first = i < 30 ? 0 : 1;
    sites[i].count = 1;
    sites[i].jacobian[0] = 1.0;
    findings[i].inside = true;
    findings[i].weight = i < 30 ? 1.0 : 0.0;
  }
  const Eigen::MatrixXd covariance = Eigen::Vector2d(0.04, 25.0).asDiagonal();
  for (const bool deforms : {true, false}) {
    EdgeReport report;
    report.reason = Reason::kNone;
    report.sigma = 0.2;
    judge({sites, findings, covariance, 2, deforms, 20.0, 1.0}, EdgeConfig(), 0.3, report);
    EXPECT_DOUBLE_EQ(report.expected_error, deforms ? 0.2 : 5.0);
    EXPECT_EQ(report.reason, deforms ? Reason::kNone : Reason::kUncertain);
  }
}

// As many edges agree with both curves, with one of them more closely.
TEST(EdgeVerdict, edgesThatAgreeMoreCloselyAreMoreEvidence) {
  std::vector<Site> sites(60);
  std::vector<SiteFinding> findings(sites.size());
  const Eigen::MatrixXd covariance = Eigen::MatrixXd::Constant(1, 1, 0.01);
  const auto evidenceAt = [&](double distance) {
    for (std::size_t i = 0; i < sites.size(); ++i) {
      sites[i].count = 1;
      findings[i].inside = true;
      findings[i].weight = i < 45 ? 1.0 : 0.0;
      findings[i].edge = findings[i].point + Eigen::Vector2d(0.0, i % 2 == 0 ? distance : -distance);
    }
    EdgeReport report;
    report.sigma = distance;
    judge({sites, findings, covariance, 1, false, 6.0, 2.0}, EdgeConfig(), 0.3, report);
    EXPECT_EQ(report.used, 45);
    return report.evidence;
  };
  EXPECT_GT(evidenceAt(0.1), evidenceAt(0.4) + 10.0);
  EXPECT_GT(evidenceAt(0.4), evidenceAt(0.9) + 10.0);
  EXPECT_GT(evidenceAt(0.9), 0.0);
}

TEST(EdgeVerdict, edgesOfNeighbouringSitesErrAlike) {
  EXPECT_EQ(correlation(4.0), 2.0);
  EXPECT_EQ(correlation(20.0), 1.0);
}

}  // namespace
}  // namespace laparoscope_servo::features
