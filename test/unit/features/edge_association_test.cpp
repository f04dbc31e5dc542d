#include "laparoscope_servo/features/edge_association.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace laparoscope_servo::features {
namespace {

constexpr double kRange = 6.0;

// A straight line along x, of one parameter: its displacement along y.
struct Straight {
  explicit Straight(int count) {
    for (int i = 0; i < count; ++i) {
      Site site;
      site.point = {4.0 * i, 10.0};
      site.normal = {0.0, 1.0};
      site.count = 1;
      site.jacobian[0] = 1.0;
      site.slot = i;
      sites.push_back(site);
      candidates.emplace_back();
      candidates.back().found.inside = true;
    }
    association.reserve(count, sites.size());
  }
  void add(std::size_t site, float offset, float weight) {
    EdgeCandidates& found = candidates[site].found;
    candidates[site].weight[static_cast<std::size_t>(found.count)] = weight;
    found.at[static_cast<std::size_t>(found.count++)] = {offset, {20.0f + offset, 90.0f, 110.0f}};
  }
  // As though the fit had moved it by `step`, and believed every edge.
  double settle(double step) {
    const std::vector<double> weights(association.rows().size(), 1.0);
    return association.settle(sites, Eigen::VectorXd::Constant(1, step), weights, 0.1);
  }
  double weight(std::size_t site) const { return association.findings()[site].weight; }

  std::vector<Site> sites;
  std::vector<WeightedCandidates> candidates;
  EdgeAssociation association;
};

TEST(EdgeAssociation, choosesTheEdgeThatLooksRightTheNearerTheBetter) {
  Straight line(10);
  line.add(0, 1.0f, 0.5f);
  line.add(0, 4.0f, 0.6f);  // looks a little better, but is further off
  line.add(1, 1.0f, 0.2f);
  line.add(1, 4.0f, 0.9f);
  line.add(2, 1.0f, 0.0f);  // is none of the curve's
  line.association.choose(line.sites, line.candidates, kRange);
  ASSERT_EQ(line.association.rows().size(), 2u);
  EXPECT_EQ(line.association.rows()[0].b, 1.0);
  EXPECT_EQ(line.association.rows()[1].b, 4.0);
  EXPECT_EQ(line.association.looks(1).contrast, 24.0f);
  EXPECT_EQ(line.association.findings()[1].edge, Eigen::Vector2d(4.0, 14.0));
  EXPECT_EQ(line.association.findings()[2].edge, line.association.findings()[2].point);
}

TEST(EdgeAssociation, edgesNextToTheMovedCurveAgree) {
  Straight line(20);
  for (std::size_t i = 0; i < 20; ++i) line.add(i, i == 5 ? -3.0f : 2.0f, 1.0f);
  line.association.choose(line.sites, line.candidates, kRange);
  EXPECT_EQ(line.settle(1.8), 1.8);
  EXPECT_EQ(line.weight(4), 1.0);
  EXPECT_EQ(line.weight(5), 0.0);
  EXPECT_EQ(line.association.findings()[4].point, Eigen::Vector2d(16.0, 11.8));
}

TEST(EdgeAssociation, edgesAmongSitesThatDoNotAgreeAreDropped) {
  Straight line(40);
  // From the twentieth site on the curve is covered, and every fifth site meets an edge of the cover.
  for (std::size_t i = 0; i < 40; ++i) {
    if (i < 20 || i % 5 == 0) line.add(i, 0.0f, 1.0f);
  }
  line.association.choose(line.sites, line.candidates, kRange);
  line.settle(0.0);
  EXPECT_EQ(line.weight(30), 1.0);
  line.association.dropLonely(line.sites, 1.0, 20.0);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(line.weight(i), 1.0) << i;
  for (std::size_t i = 28; i < 40; ++i) EXPECT_EQ(line.weight(i), 0.0) << i;
  // They have no say in the next fit, until the curve has moved as a whole.
  const auto saying = [&] {
    line.association.choose(line.sites, line.candidates, kRange);
    double sum = 0.0;
    for (const robust::Row& row : line.association.rows()) sum += row.weight;
    return sum;
  };
  EXPECT_LT(saying(), 24.0);
  line.association.forgetLonely();
  EXPECT_EQ(saying(), 24.0);
}

TEST(EdgeAssociation, theMoreStrayEdgesThereAreTheMoreNeighboursHaveToAgree) {
  for (const double stray : {1.0, 6.0}) {
    Straight line(40);
    for (std::size_t i = 0; i < 40; ++i) {
      if (i % 2 == 0) line.add(i, 0.0f, 1.0f);
    }
    line.association.choose(line.sites, line.candidates, kRange);
    line.settle(0.0);
    line.association.dropLonely(line.sites, stray, 20.0);
    EXPECT_EQ(line.weight(20), stray > 1.0 ? 0.0 : 1.0) << stray;
  }
}

TEST(Displacement, coefficientsGoOnAtTheFirstParameter) {
  Site site;
  site.first = 4;
  site.count = 3;
  site.jacobian = {1.0, 10.0, 100.0};
  Eigen::VectorXd step(5);
  step << 1.0, 2.0, 3.0, 4.0, 5.0;
  EXPECT_EQ(displacement(site, step), 5.0 + 10.0 + 200.0);
}

// A fit that has come to nothing has not settled.
TEST(EdgeAssociation, aStepThatIsNotFiniteIsNotTakenForASmallOne) {
  for (const double wrong : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Straight line(10);
    for (std::size_t i = 0; i < 10; ++i) line.add(i, 1.0f, 1.0f);
    line.association.choose(line.sites, line.candidates, kRange);
    EXPECT_FALSE(line.settle(wrong) < 1e300);
    for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(line.weight(i), 0.0);
  }
}

}  // namespace
}  // namespace laparoscope_servo::features
