#include "laparoscope_servo/features/coarse_motion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::features {
namespace {

std::vector<Site> circle(int count) {
  std::vector<Site> sites;
  for (int k = 0; k < count; ++k) {
    const double phi = 2.0 * M_PI * k / count;
    Site site;
    site.normal = {std::cos(phi), std::sin(phi)};
    site.point = Eigen::Vector2d(200.0, 150.0) + 50.0 * site.normal;
    site.slot = k;
    sites.push_back(site);
  }
  return sites;
}

WeightedCandidates candidate(double offset) {
  WeightedCandidates result;
  result.found.count = 1;
  result.found.inside = true;
  result.found.at[0].offset = static_cast<float>(offset);
  result.weight[0] = 1.0f;
  return result;
}

// Shifted by (7, -4) and grown by 3 px; of ten sites six see another edge.
TEST(CoarseMotion, findsTheMotionOfFourSitesInTen) {
  const std::vector<Site> sites = circle(60);
  std::vector<WeightedCandidates> candidates;
  for (int k = 0; k < 60; ++k) {
    const double true_offset = sites[static_cast<std::size_t>(k)].normal.dot(Eigen::Vector2d(7.0, -4.0)) + 3.0;
    candidates.push_back(candidate(k * 7 % 10 < 6 ? -18.0 + (k * 13 % 37) : true_offset));
  }
  CoarseMotion coarse;
  const CoarseResult result = coarse.find(sites, candidates, 20.0);
  for (const Site& site : sites) {
    const Eigen::Vector3d moved = result.motion * site.point.homogeneous();
    const double along = site.normal.dot(moved.head<2>() - site.point);
    EXPECT_NEAR(along, site.normal.dot(Eigen::Vector2d(7.0, -4.0)) + 3.0, 1.0);
  }
  EXPECT_NEAR(result.largest, std::hypot(7.0, 4.0) + 3.0, 1.0);
  EXPECT_GT(result.score, 20.0);
}

TEST(CoarseMotion, staysWhereNothingIsSeen) {
  const std::vector<Site> sites = circle(20);
  CoarseMotion coarse;
  const CoarseResult nothing = coarse.find(sites, std::vector<WeightedCandidates>(20), 20.0);
  EXPECT_EQ(nothing.score, 0.0);
  EXPECT_TRUE(nothing.motion.isIdentity());
  EXPECT_EQ(coarse.find({}, {}, 20.0).score, 0.0);
}

TEST(CoarseMotion, givesTheSameEachTime) {
  const std::vector<Site> sites = circle(40);
  std::vector<WeightedCandidates> candidates;
  for (int k = 0; k < 40; ++k) candidates.push_back(candidate(-18.0 + (k * 13 % 37)));
  CoarseMotion a, b;
  b.find(sites, candidates, 10.0);
  EXPECT_EQ(a.find(sites, candidates, 20.0).motion, b.find(sites, candidates, 20.0).motion);
}

TEST(CoarseMotion, aDisplacementThatIsNotFiniteIsNotTakenForASmallOne) {
  std::vector<Site> sites = circle(20);
  const std::vector<WeightedCandidates> candidates(20, candidate(1.0));
  sites[7].normal.x() = std::nan("");
  CoarseMotion coarse;
  EXPECT_FALSE(coarse.find(sites, candidates, 20.0).largest < 1e300);
}

}  // namespace
}  // namespace laparoscope_servo::features
