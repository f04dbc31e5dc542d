#include "tracking/esm/esm_level.h"

#include <gtest/gtest.h>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {41, 33, 100, 60};

image::RegionPyramid pyramid(const image::Channels& channels = image::kLuma) {
  image::RegionPyramid built;
  built.build(test::tissue(cv::Size(200, 160), 2), cv::Rect(11, 7, 170, 140), 4, channels);
  return built;
}

TEST(EsmLevelTest, ShowsTheReferenceWhereItSays) {
  const image::RegionPyramid reference = pyramid();
  for (int l = 0; l < 3; ++l) {
    const EsmLevel level(reference, kRoi, l);
    ASSERT_EQ(level.planes.size(), 1u);
    EXPECT_EQ(level.scale, 1 << l);
    // The first and the last pixel lie on the ROI, and on a pixel of the pyramid.
    const Eigen::Vector3d first = level.image_T_patch * Eigen::Vector3d(0, 0, 1);
    const Eigen::Vector3d last = level.image_T_patch * Eigen::Vector3d(level.width - 1, level.height - 1, 1);
    EXPECT_GE(first.x(), kRoi.x);
    EXPECT_GE(first.y(), kRoi.y);
    EXPECT_LE(last.x(), kRoi.x + kRoi.width - 1);
    EXPECT_LE(last.y(), kRoi.y + kRoi.height - 1);
    EXPECT_EQ(level.first, cv::Point(static_cast<int>(first.x() - kRoi.x), static_cast<int>(first.y() - kRoi.y)));
    const cv::Point at((static_cast<int>(last.x()) - 11) >> l, (static_cast<int>(last.y()) - 7) >> l);
    EXPECT_EQ(level.planes[0].value(level.height - 1, level.width - 1), reference.level(l)(at.y, at.x));
  }
}

TEST(EsmLevelTest, TakesAnotherReferenceAsIfItWereMadeOfIt) {
  image::RegionPyramid other;
  other.build(test::tissue(cv::Size(200, 160), 9), cv::Rect(11, 7, 170, 140), 4, image::kLuma);
  for (int l = 0; l < 3; ++l) {
    EsmLevel level(pyramid(), kRoi, l);
    level.take(other, l);
    const EsmLevel made(other, kRoi, l);
    for (int j = -1; j <= level.height; ++j) {
      for (int i = -1; i <= level.width; ++i) {
        ASSERT_EQ(level.planes[0].value(j, i), made.planes[0].value(j, i)) << "level " << l << " at " << i << ", " << j;
      }
    }
  }
}

TEST(EsmLevelTest, IsEmptyWhereItWouldBeTooSmall) {
  EXPECT_TRUE(EsmLevel(pyramid(), kRoi, 3).planes.empty());
}  // 60 / 8 px

TEST(EsmLevelTest, HasAPlaneForEachChannel) {
  const EsmLevel level(pyramid({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), kRoi, 0);
  ASSERT_EQ(level.planes.size(), 3u);
  EXPECT_GT(cv::norm(level.planes[0].value.view(), level.planes[2].value.view()), 0.0);
}

TEST(EsmLevelTest, BlocksOfLightAreWholeStripsAndCoverEverything) {
  for (int side : {16, 40, 100, 150}) {
    image::RegionPyramid reference;
    reference.build(test::tissue(cv::Size(220, 220), 2), cv::Rect(0, 0, 220, 220), 1, image::kLuma);
    const EsmLevel level(reference, {3.0, 5.0, static_cast<double>(side), static_cast<double>(side)}, 0);
    EXPECT_EQ(static_cast<int>(level.light_column_of_strip.size()), level.weight.strips());
    EXPECT_EQ(level.light_column_of_strip.front(), 0);
    EXPECT_EQ(level.light_column_of_strip.back(), level.light_columns - 1);
    EXPECT_EQ(level.light_row_begin.front(), 0);
    EXPECT_EQ(level.light_row_begin.back(), side);
    EXPECT_EQ(level.planes[0].bias.size(), level.light_columns * (level.light_row_begin.size() - 1));
  }
}

TEST(EsmLevelTest, LightIsInheritedFromTheBlockAbove) {
  image::RegionPyramid reference;
  reference.build(test::tissue(cv::Size(220, 220), 2), cv::Rect(0, 0, 220, 220), 2, image::kLuma);
  const geometry::Rectangle roi = {9, 11, 196, 160};
  EsmLevel fine(reference, roi, 0), coarse(reference, roi, 1);
  matchLightBlocks(coarse, fine);
  ASSERT_EQ(fine.coarser_light_block.size(), fine.planes[0].bias.size());
  EXPECT_EQ(fine.coarser_light_block.front(), 0);
  EXPECT_EQ(fine.coarser_light_block.back(), static_cast<int>(coarse.planes[0].bias.size()) - 1);
  for (std::size_t k = 0; k < coarse.planes[0].bias.size(); ++k)
    coarse.planes[0].bias[k] = coarse.planes[0].before[k] + k;
  fine.planes[0].bias.assign(fine.planes[0].bias.size(), 3.0);
  inheritLight(coarse, fine);
  for (std::size_t k = 0; k < fine.planes[0].bias.size(); ++k)
    EXPECT_EQ(fine.planes[0].bias[k], 3.0 + fine.coarser_light_block[k]);
}

TEST(EsmLevelTest, ABlocksBiasIsAboutItsMean) {
  EsmLevel level(pyramid(), kRoi, 0);
  EXPECT_EQ(level.planes[0].biasOf(0, 2.0), 0.0);
  level.centreLight();
  const cv::Rect first_block(0, 0, image::Patch::kStrip, level.light_row_begin[1]);
  const double mean = cv::mean(level.planes[0].value.view()(first_block))[0];
  EXPECT_NEAR(level.planes[0].biasOf(0, 2.0), -mean, 1e-3);
}

TEST(EsmLevelTest, UsesWhatIsValidWithItsNeighbours) {
  EsmLevel level(pyramid(), kRoi, 0);
  level.valid.view().setTo(1.0f);
  level.valid(10, 20) = 0.0f;
  level.weight(30, 30) = 0.0f;
  level.all_valid = false;
  level.useValid();
  const cv::Mat1f used = level.used.view();
  EXPECT_EQ(cv::countNonZero(used == 0.0f), 5 + 1);  // a cross, and the pixel without weight
  EXPECT_EQ(used(9, 20), 0.0f);
  EXPECT_EQ(used(10, 21), 0.0f);
  EXPECT_EQ(used(9, 19), 1.0f);
  EXPECT_EQ(used(0, 0), 1.0f);  // beyond the patch nothing is missing
  EXPECT_EQ(&level.usedWeight(), &level.used);
}

TEST(EsmLevelTest, CoarserWeightsAreTheLeastOfWhatTheyCover) {
  EsmLevel fine(pyramid(), kRoi, 0), coarse(pyramid(), kRoi, 1);
  std::vector<float> scratch;
  coarsenWeights(fine, scratch, coarse);
  EXPECT_EQ(cv::countNonZero(coarse.weight.view() < 1.0f), 0);
  // The fine pixel that lies on the coarse pixel (4, 3), and its neighbours, are in that one; the next is not.
  const cv::Point on = coarse.first - fine.first + cv::Point(8, 6);
  fine.weight(on.y + 1, on.x - 1) = 0.25f;
  coarsenWeights(fine, scratch, coarse);
  EXPECT_EQ(coarse.weight(3, 4), 0.25f);
  EXPECT_EQ(coarse.weight(3, 5), 1.0f);
  EXPECT_EQ(coarse.weight(4, 3), 0.25f);  // odd rows and columns belong to both sides
}

}  // namespace
}  // namespace laparoscope_servo::tracking
