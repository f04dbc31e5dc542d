#include "laparoscope_servo/features/edge_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic_edges.h"

namespace laparoscope_servo::features {
namespace {

// The candidate next to the site; the test fails where there is none.
EdgeCandidate nearest(const cv::Mat& image, const Site& site, const EdgeWindow& window = {10.0, 1.0}) {
  EdgeSearch search;
  EdgeCandidates found;
  search.find(image, site, window, 8.0, found);
  EXPECT_TRUE(found.inside);
  EXPECT_GT(found.count, 0);
  EdgeCandidate best;
  best.offset = 1e3f;
  for (int k = 0; k < found.count; ++k) {
    const EdgeCandidate& candidate = found.at[static_cast<std::size_t>(k)];
    if (std::abs(candidate.offset) < std::abs(best.offset)) best = candidate;
  }
  return best;
}

Site siteAt(double x, double y, double theta) {
  Site site;
  site.point = {x, y};
  site.normal = {std::cos(theta), std::sin(theta)};
  return site;
}

TEST(EdgeSearch, findsAnEdgeWhereItIsInEveryDirection) {
  test::EdgeScene scene;
  scene.size = {120, 120};
  scene.noise = 0.0;
  for (double theta = -3.0; theta < 3.2; theta += 0.37) {
    const Eigen::Vector2d n(std::cos(theta), std::sin(theta));
    const cv::Mat image = test::draw(scene, test::halfPlane(n.dot(Eigen::Vector2d(60.0, 60.0)), theta));
    double mean = 0.0;
    for (double d = -3.0; d <= 3.0; d += 0.3) {
      const Eigen::Vector2d p = Eigen::Vector2d(60.0, 60.0) - d * n;
      const EdgeCandidate found = nearest(image, siteAt(p.x(), p.y(), theta));
      EXPECT_NEAR(found.offset, d, 0.08) << theta;
      EXPECT_GT(found.looks.contrast, 30.0f);
      EXPECT_GT(found.looks.ahead, found.looks.behind);
      mean += (static_cast<double>(found.offset) - d) / 21.0;
    }
    EXPECT_NEAR(mean, 0.0, 0.02) << theta;
  }
}

TEST(EdgeSearch, theContrastIsPositiveWhereTheNormalPointsToTheBrighterSide) {
  test::EdgeScene scene;
  const cv::Mat image = test::draw(scene, test::halfPlane(100.0, 0.0));
  EXPECT_GT(nearest(image, siteAt(98.0, 100.0, 0.0)).looks.contrast, 0.0f);
  EXPECT_LT(nearest(image, siteAt(98.0, 100.0, M_PI)).looks.contrast, 0.0f);
}

// The mask's tangent is straight, the edge is not.
TEST(EdgeSearch, takesCurvatureIntoAccount) {
  test::EdgeScene scene;
  scene.noise = 0.0;
  scene.blur = 0.5;
  constexpr double kRadius = 15.0;
  const cv::Mat image = test::draw(scene, test::ellipse({160.0, 120.0}, kRadius, kRadius, 0.0));
  double mean = 0.0;
  for (int k = 0; k < 32; ++k) {
    const double phi = 0.196 * k;
    Site site = siteAt(160.0 + kRadius * std::cos(phi), 120.0 + kRadius * std::sin(phi), phi);
    site.curvature = 1.0 / kRadius;
    mean += static_cast<double>(nearest(image, site).offset) / 32.0;
  }
  EXPECT_NEAR(mean, 0.0, 0.03);
}

TEST(EdgeSearch, returnsSeveralEdgesAndNoneOfNoise) {
  test::EdgeScene scene;
  const auto stripe = [](const Eigen::Vector2d& p) { return p.x() > 90.0 && p.x() < 104.0; };
  EdgeSearch search;
  EdgeCandidates found;
  search.find(test::draw(scene, stripe), siteAt(97.0, 100.0, 0.0), {12.0, 1.0}, 8.0, found);
  ASSERT_EQ(found.count, 2);
  EXPECT_NEAR(found.at[0].offset, -7.0, 0.3);
  EXPECT_NEAR(found.at[1].offset, 7.0, 0.3);
  search.find(test::draw(scene, [](const Eigen::Vector2d&) { return false; }), siteAt(97.0, 100.0, 0.0), {12.0, 1.0},
              8.0, found);
  EXPECT_EQ(found.count, 0);
}

TEST(EdgeSearch, readsTheLumaOfColours) {
  test::EdgeScene scene;
  const cv::Mat grey = test::draw(scene, test::halfPlane(100.0, 0.0));
  cv::Mat colour;
  cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
  const EdgeCandidate a = nearest(grey, siteAt(98.0, 100.0, 0.0)), b = nearest(colour, siteAt(98.0, 100.0, 0.0));
  EXPECT_NEAR(a.offset, b.offset, 1e-3);
  EXPECT_NEAR(a.looks.contrast, b.looks.contrast, 1e-2);
}

TEST(EdgeSearch, readsNothingOutsideTheImage) {
  test::EdgeScene scene;
  const cv::Mat image = test::draw(scene, test::halfPlane(100.0, 0.0));
  EdgeSearch search;
  EdgeCandidates found;
  for (const Eigen::Vector2d& p :
       {Eigen::Vector2d(-5.0, 100.0), Eigen::Vector2d(319.5, 100.0), Eigen::Vector2d(100.0, 300.0),
        Eigen::Vector2d(1e9, 1.0), Eigen::Vector2d(0.0, 0.0)}) {
    search.find(image, siteAt(p.x(), p.y(), 0.3), {20.0, 2.0}, 8.0, found);
    EXPECT_FALSE(found.inside);
    EXPECT_EQ(found.count, 0);
  }
  // Near the border as far as there are pixels.
  search.find(image, siteAt(10.0, 100.0, 0.0), {100.0, 1.0}, 8.0, found);
  EXPECT_TRUE(found.inside);
  EXPECT_EQ(found.count, 1);
}

TEST(EdgeLooks, similarityKnowsSignContrastAndSides) {
  const EdgeLooks looks{40.0f, 90.0f, 130.0f};
  EXPECT_FLOAT_EQ(similarity(looks, looks, 0.4f), 1.0f);
  EXPECT_EQ(similarity(looks, {-40.0f, 130.0f, 90.0f}, 0.4f), 0.0f);
  EXPECT_EQ(similarity(looks, {15.0f, 90.0f, 130.0f}, 0.4f), 0.0f);
  EXPECT_EQ(similarity(looks, {40.0f, 190.0f, 240.0f}, 0.4f), 0.0f);
  // A background that changes leaves one side.
  EXPECT_GT(similarity(looks, {80.0f, 30.0f, 130.0f}, 0.4f), 0.3f);
  EXPECT_TRUE(looksAlike(looks, {44.0f, 95.0f, 139.0f}));
  EXPECT_FALSE(looksAlike(looks, {40.0f, 150.0f, 190.0f}));
}

}  // namespace
}  // namespace laparoscope_servo::features
