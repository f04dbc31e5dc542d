#include "screen/features/feature_result.h"

#include <gtest/gtest.h>

#include <limits>

#include "unit/screen/features/feature_facts_examples.h"

namespace laparoscope_servo::screen {
namespace {

using test_support::featuresMessage;
using test_support::lineMessage;

TEST(FeatureResult, KeepsWhatIsDrawn) {
  const auto result = featureResult(featuresMessage(12.5, {lineMessage()}));
  EXPECT_EQ(result->stamp, 12500000000);
  EXPECT_EQ(result->frame, "camera");
  EXPECT_EQ(result->state, TrackedFeatures::TRACKING);
  ASSERT_EQ(result->features.size(), 1u);
  const FeatureFact& line = result->features[0];
  EXPECT_EQ(line.id, "shaft");
  EXPECT_EQ(line.kind, TrackedFeature::LINE);
  EXPECT_EQ(line.outline, QPolygonF(QVector<QPointF>{{100.0, 60.0}, {300.0, 60.0}}));
  EXPECT_EQ(line.covariance.size(), 4u);
}

TEST(FeatureResult, LeavesOutWhatCannotBeDrawn) {
  for (const double nowhere :
       {std::numeric_limits<double>::quiet_NaN(), 1e9, -std::numeric_limits<double>::infinity()}) {
    TrackedFeature line = lineMessage();
    line.outline[2] = nowhere;
    EXPECT_TRUE(featureResult(featuresMessage(1.0, {line}))->features[0].outline.isEmpty()) << nowhere;
  }
  TrackedFeature line = lineMessage();
  line.outline = {100.0};
  EXPECT_TRUE(featureResult(featuresMessage(1.0, {line}))->features[0].outline.isEmpty()) << "half a point";
  line.covariance[3] = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(featureResult(featuresMessage(1.0, {line}))->features[0].covariance.empty());
  line.covariance = {1.0, 0.0, 1.0};
  EXPECT_TRUE(featureResult(featuresMessage(1.0, {line}))->features[0].covariance.empty()) << "of another size";
}

TEST(FeatureResult, IsBounded) {
  TrackedFeature line = lineMessage();
  line.outline.assign(100000, 5.0);
  const auto result = featureResult(featuresMessage(1.0, std::vector<TrackedFeature>(1000, line)));
  EXPECT_LE(result->features.size(), 200u);
  EXPECT_LE(result->features[0].outline.size(), 2000);
}

}  // namespace
}  // namespace laparoscope_servo::screen
