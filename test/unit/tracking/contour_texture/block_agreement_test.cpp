#include "tracking/contour_texture/block_agreement.h"

#include <gtest/gtest.h>

#include "laparoscope_servo/image/pyramid.h"
#include "support/synthetic_edges.h"

namespace laparoscope_servo::tracking {
namespace {

constexpr double kNoise = 2.0;
const cv::Size kSize(120, 96);  // 80 blocks

class BlockAgreementTest : public testing::Test {
 protected:
  static EsmLevel levelOf(double contrast) {
    cv::Mat image;
    test::texture(kSize, 120.0, contrast, 2.0, 5).convertTo(image, CV_8UC1);
    image::RegionPyramid pyramid;
    pyramid.build(image, cv::Rect(cv::Point(0, 0), kSize), 1, image::kLuma);
    EsmLevel level(pyramid, {0.0, 0.0, 120.0, 96.0}, 0);
    for (int y = 0; y < level.height; ++y) std::fill_n(level.weight.row(y), level.width, 1.0f);
    level.all_valid = true;
    return level;
  }
  // What the image shows: the reference, brighter by `gain` and `bias`, moved to the side by `shift` columns.
  static void show(EsmLevel& level, float gain = 1.0f, float bias = 0.0f, int shift = 0) {
    EsmPlane& plane = level.planes[0];
    plane.warped.resize(level.width, level.height);
    for (int y = 0; y < level.height; ++y) {
      for (int x = 0; x < level.width; ++x)
        plane.warped(y, x) = gain * plane.value(y, (x + shift) % level.width) + bias;
    }
  }
};

TEST_F(BlockAgreementTest, AllBlocksCorrelateWhereTheImageIsTheReferenceWhateverItsLight) {
  EsmLevel level = levelOf(15.0);
  for (const float gain : {1.0f, 0.6f, 1.5f}) {
    show(level, gain, 20.0f);
    const BlockAgreement found = blockAgreement(level, kNoise, 0.6);
    EXPECT_EQ(found.blocks, 80);
    EXPECT_EQ(found.correlate, 80);
    EXPECT_EQ(found.share(), 1.0);
  }
}

TEST_F(BlockAgreementTest, FewDoWhereItIsElsewhere) {
  EsmLevel level = levelOf(15.0);
  show(level, 1.0f, 0.0f, 20);
  EXPECT_LT(blockAgreement(level, kNoise, 0.6).share(), 0.2);
}

TEST_F(BlockAgreementTest, WithoutTextureThereAreNoBlocks) {
  EsmLevel level = levelOf(1.0);
  show(level);
  EXPECT_EQ(blockAgreement(level, kNoise, 0.6).blocks, 0);
  EXPECT_EQ(blockAgreement(level, kNoise, 0.6).share(), 0.0);
}

TEST_F(BlockAgreementTest, OnlyWhatHasAWeightCounts) {
  EsmLevel level = levelOf(15.0);
  show(level);
  for (int y = 0; y < level.height; ++y) std::fill_n(level.weight.row(y), level.width / 2, 0.0f);
  const BlockAgreement found = blockAgreement(level, kNoise, 0.6);
  EXPECT_EQ(found.blocks, 40);
  EXPECT_EQ(found.correlate, 40);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
