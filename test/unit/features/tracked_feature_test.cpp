#include "laparoscope_servo/features/tracked_feature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "laparoscope_servo/features/curve.h"

namespace laparoscope_servo::features {
namespace {

TrackedFeature feature(const std::string& id, State state, const std::string& reason) {
  TrackedFeature result;
  result.id = id;
  result.state = state;
  result.reason = reason;
  return result;
}

TEST(TrackedFeature, allOfThemAreInTheWorstStateOfOneAndTellWhose) {
  TrackedFeatures all;
  summarise(all, "none is there");
  EXPECT_EQ(all.state, State::kIdle);
  EXPECT_EQ(all.reason, "none is there");
  all.features = {feature("a", State::kTracking, ""), feature("b", State::kTracking, "")};
  summarise(all, "none is there");
  EXPECT_EQ(all.state, State::kTracking);
  EXPECT_EQ(all.reason, "");
  all.features[0] = feature("a", State::kSearching, "covered");
  all.features.push_back(feature("c", State::kSearching, "outside"));
  summarise(all, "none is there");
  EXPECT_EQ(all.state, State::kSearching);
  EXPECT_EQ(all.reason, "a: covered") << "the first one's of those that are as bad";
  all.features.push_back(feature("d", State::kLost, "unlike"));
  summarise(all, "none is there");
  EXPECT_EQ(all.state, State::kLost);
  EXPECT_EQ(all.reason, "d: unlike");
}

TEST(TrackedFeature, whatIsNotKnownHasInfiniteVariancesAndNoCovariances) {
  Eigen::MatrixXd covariance;
  setUnknown(covariance, 3);
  ASSERT_EQ(covariance.rows(), 3);
  for (int j = 0; j < 3; ++j) {
    for (int k = 0; k < 3; ++k) {
      if (j == k) {
        EXPECT_TRUE(std::isinf(covariance(j, k)) && covariance(j, k) > 0.0);
      } else {
        EXPECT_EQ(covariance(j, k), 0.0);
      }
    }
  }
}

TEST(TrackedFeature, sitesAreToldThatAreInTheImageAndOfTheCurve) {
  std::vector<SiteFinding> findings(3);
  findings[0].inside = true;
  findings[0].point = {1.0, 2.0};
  findings[0].weight = 0.5;
  findings[1].inside = true;
  findings[1].probe = true;
  std::vector<TrackedSite> sites(7);
  tellSites(findings, sites);
  ASSERT_EQ(sites.size(), 1u);
  EXPECT_EQ(sites[0].point, Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(sites[0].weight, 0.5);
}

TEST(TrackedFeature, everyKindHasANameOfItsOwn) {
  std::set<std::string> names;
  for (int kind = 0; kind <= static_cast<int>(FeatureKind::kHomography); ++kind) {
    names.insert(kindName(static_cast<FeatureKind>(kind)));
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(FeatureKind::kHomography) + 1);
  EXPECT_EQ(names.count(""), 0u);
}

}  // namespace
}  // namespace laparoscope_servo::features
