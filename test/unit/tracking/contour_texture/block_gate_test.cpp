#include "tracking/contour_texture/block_gate.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "laparoscope_servo/image/pyramid.h"
#include "support/synthetic_edges.h"

namespace laparoscope_servo::tracking {
namespace {

constexpr double kNoise = 2.0;
const cv::Size kSize(120, 96);  // 80 blocks

class BlockGateTest : public testing::Test {
 protected:
  explicit BlockGateTest(double contrast = 15.0) : level_(levelOf(contrast)) {
    gate_.setReference(level_, cv::Mat1f::ones(kSize), kNoise);
  }

  static EsmLevel levelOf(double contrast) {
    cv::Mat image;
    test::texture(kSize, 120.0, contrast, 2.0, 5).convertTo(image, CV_8UC1);
    image::RegionPyramid pyramid;
    pyramid.build(image, cv::Rect(cv::Point(0, 0), kSize), 1, image::kLuma);
    EsmLevel level(pyramid, {0.0, 0.0, 120.0, 96.0}, 0);
    level.all_valid = true;
    return level;
  }
  // What the image shows: the reference, brighter by `gain` and `bias`, moved to the side by `shift` columns.
  void show(float gain = 1.0f, float bias = 0.0f, int shift = 0) {
    EsmPlane& plane = level_.planes[0];
    plane.warped.resize(level_.width, level_.height);
    for (int y = 0; y < level_.height; ++y) {
      for (int x = 0; x < level_.width; ++x)
        plane.warped(y, x) = gain * plane.value(y, (x + shift) % level_.width) + bias;
    }
  }
  void cover(const cv::Rect& box, float grey) { level_.planes[0].warped.view()(box).setTo(grey); }

  EsmLevel level_;
  BlockGate gate_;
};

class FlatBlockGateTest : public BlockGateTest {
 protected:
  FlatBlockGateTest() : BlockGateTest(1.0) {}
};

TEST_F(BlockGateTest, AllBlocksCorrelateWhereTheImageIsTheReferenceWhateverItsLight) {
  for (const float gain : {1.0f, 0.6f, 1.5f}) {
    show(gain, 20.0f);
    EXPECT_EQ(gate_.look(level_, 0.6), 0);
    EXPECT_EQ(gate_.textured(), 80);
    EXPECT_EQ(gate_.correlated(), 80);
    EXPECT_EQ(gate_.share(), 1.0);
    EXPECT_EQ(cv::countNonZero(gate_.weights() != 1.0f), 0);
  }
}

TEST_F(BlockGateTest, FewDoWhereItIsElsewhere) {
  show(1.0f, 0.0f, 20);
  gate_.look(level_, 0.6);
  EXPECT_LT(gate_.share(), 0.2);
}

TEST_F(BlockGateTest, WhatIsCoveredHasNoWeightUntilItIsSeenAgain) {
  const cv::Rect left(0, 0, 60, 96);
  show();
  cover(left, 90.0f);
  EXPECT_EQ(gate_.look(level_, 0.6), 40);
  EXPECT_EQ(gate_.look(level_, 0.6), 0) << "known already";
  EXPECT_EQ(gate_.correlated(), 40);
  EXPECT_EQ(cv::countNonZero(gate_.weights()(left)), 0);
  EXPECT_EQ(cv::countNonZero(gate_.weights()), 60 * 96);
  show();
  EXPECT_EQ(gate_.look(level_, 0.6), 0);
  EXPECT_EQ(cv::countNonZero(gate_.weights()), 120 * 96);
}

// Two of twelve columns of eight blocks are covered: that counts beside blocks that are covered in whole, and not by
// itself.
TEST_F(BlockGateTest, BesideACoveredBlockMoreCorrelationIsExpected) {
  const auto correlated = [&](const cv::Rect& covered) {
    show();
    cover(covered, 90.0f);
    gate_.forget();
    gate_.look(level_, 0.3);
    return gate_.correlated();
  };
  EXPECT_EQ(correlated({60, 0, 2, 96}), 80);
  EXPECT_EQ(correlated({0, 0, 60, 96}), 40);
  EXPECT_LT(correlated({0, 0, 62, 96}), 40);
}

TEST_F(BlockGateTest, WhatWasCoveredIsForgotten) {
  show();
  cover({0, 0, 60, 96}, 90.0f);
  gate_.look(level_, 0.6);
  gate_.forget();
  EXPECT_EQ(cv::countNonZero(gate_.weights()), 120 * 96);
  EXPECT_EQ(gate_.look(level_, 0.6), 40);
}

TEST_F(FlatBlockGateTest, WithoutTextureThereAreNoBlocks) {
  show();
  EXPECT_EQ(gate_.look(level_, 0.6), 0);
  EXPECT_EQ(gate_.textured(), 0);
  EXPECT_EQ(gate_.share(), 0.0);
}

TEST_F(BlockGateTest, OnlyWhatHasAWeightAndLiesInTheImageCounts) {
  cv::Mat1f half = cv::Mat1f::ones(kSize);
  half(cv::Rect(0, 0, 60, 96)).setTo(0.0f);
  gate_.setReference(level_, half, kNoise);
  show();
  gate_.look(level_, 0.6);
  EXPECT_EQ(gate_.textured(), 40);
  level_.all_valid = false;
  level_.valid.resize(120, 96);
  level_.valid.view().setTo(1.0f);
  level_.valid.view()(cv::Rect(0, 0, 120, 48)).setTo(0.0f);
  gate_.look(level_, 0.6);
  EXPECT_EQ(gate_.textured(), 20);
  EXPECT_EQ(gate_.correlated(), 20);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
