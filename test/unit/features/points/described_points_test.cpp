#include "laparoscope_servo/features/described_points.h"

#include <gtest/gtest.h>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::features {
namespace {

class DescribedPointsTest : public ::testing::Test {
 protected:
  cv::Mat1b grey_;
  cv::Mat1b all_ = cv::Mat1b(160, 200, static_cast<uchar>(255));
  void SetUp() override { cv::cvtColor(test::tissue(cv::Size(200, 160), 5), grey_, cv::COLOR_BGR2GRAY); }
};

TEST_F(DescribedPointsTest, GivesAboutAsManyAsAreAskedForEachWithADescriptor) {
  const DescribedPoints drawn = drawPoints(grey_, all_, 100);
  EXPECT_GE(drawn.points.size(), 60u);
  EXPECT_LE(drawn.points.size(), 110u);
  EXPECT_EQ(drawn.descriptors.rows, static_cast<int>(drawn.points.size()));
  EXPECT_LE(drawPoints(grey_, all_, 20).points.size(), 25u);
}

TEST_F(DescribedPointsTest, OnlyWhereTheMaskIs) {
  cv::Mat1b half = all_.clone();
  half.colRange(0, 100).setTo(0);
  const DescribedPoints drawn = drawPoints(grey_, half, 200);
  ASSERT_FALSE(drawn.points.empty());
  for (const cv::Point2f& point : drawn.points) EXPECT_GE(point.x, 99.0f);
}

TEST_F(DescribedPointsTest, AThirdOfTheUsualContrastGivesPointsThatAreTheSame) {
  cv::Mat1b dim;
  grey_.convertTo(dim, -1, 0.33, 60.0);
  const DescribedPoints bright = drawPoints(grey_, all_, 100);
  const DescribedPoints faint = drawPoints(dim, all_, 300);
  ASSERT_GE(faint.points.size(), 60u);
  const cv::Mat1f distance = descriptorDistances(bright, faint);
  int same = 0;
  for (int j = 0; j < distance.rows; ++j) {
    cv::Point nearest;
    cv::minMaxLoc(distance.row(j), nullptr, nullptr, &nearest);
    same += cv::norm(bright.points[j] - faint.points[nearest.x]) < 2.0 ? 1 : 0;
  }
  EXPECT_GE(same, distance.rows / 2);
}

TEST_F(DescribedPointsTest, NothingInWhatIsSmoothOrTiny) {
  EXPECT_TRUE(drawPoints(cv::Mat1b(160, 200, static_cast<uchar>(80)), all_, 100).points.empty());
  EXPECT_TRUE(drawPoints(cv::Mat1b(8, 200), cv::Mat1b(8, 200), 100).points.empty());
}

}  // namespace
}  // namespace laparoscope_servo::features
