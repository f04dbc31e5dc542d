#include "tracking/align/region_aligner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {100, 80, 120, 110};
const cv::Size kSize(330, 280);

class RegionAlignerTest : public ::testing::Test {
 protected:
  cv::Mat scene_ = cv::min(test::tissue(kSize, 21), 240);
  TrackerConfig config_;
  cv::RNG rng_{9};

  RegionAligner alignerOn(const cv::Mat& image) {
    RegionAligner aligner(config_);
    aligner.setReference(image, kRoi);
    return aligner;
  }
};

TEST_F(RegionAlignerTest, FindsTheMotionInWhateverChannels) {
  const Eigen::Matrix3d truth = test::randomHomography(kRoi, 3.0, rng_);
  const cv::Mat image = test::view(scene_, truth, 0.9, 5.0, 1.0, 3);
  for (TrackedChannels channels : {TrackedChannels::kLuma, TrackedChannels::kStrongest, TrackedChannels::kColour}) {
    config_.esm.channels = channels;
    RegionAligner aligner = alignerOn(scene_);
    const Alignment found = aligner.align(image, EsmState(), nullptr, 32.0);
    EXPECT_LT(geometry::cornerDistance(found.esm.state.g, truth, kRoi), 0.15);
    EXPECT_GT(found.visible_fraction, 0.97);
    EXPECT_GT(found.zncc, 0.9);
    EXPECT_GT(aligner.detail(), 0.8);
    EXPECT_EQ(aligner.channels().count, channels == TrackedChannels::kColour ? 3 : 1);
  }
}

TEST_F(RegionAlignerTest, TracksAnImageWithoutColourByItsReferenceWithColour) {
  const Eigen::Matrix3d truth = test::randomHomography(kRoi, 2.0, rng_);
  cv::Mat mono;
  cv::cvtColor(test::view(scene_, truth), mono, cv::COLOR_BGR2GRAY);
  config_.esm.channels = TrackedChannels::kColour;
  RegionAligner aligner = alignerOn(scene_);
  EXPECT_LT(geometry::cornerDistance(aligner.align(mono, EsmState(), nullptr, 32.0).esm.state.g, truth, kRoi), 0.3);
}

TEST_F(RegionAlignerTest, LeavesOutWhatIsCovered) {
  const Eigen::Matrix3d truth = test::randomHomography(kRoi, 2.0, rng_);
  cv::Mat image = test::view(scene_, truth);
  image(cv::Rect(100, 80, 55, 110)).setTo(cv::Scalar(190, 190, 190));          // a plain colour
  scene_(cv::Rect(10, 10, 65, 40)).copyTo(image(cv::Rect(155, 150, 65, 40)));  // tissue from elsewhere
  RegionAligner aligner = alignerOn(scene_);
  const Alignment found = aligner.align(image, EsmState(), nullptr, 32.0);
  EXPECT_LT(geometry::cornerDistance(found.esm.state.g, truth, kRoi), 0.5);
  EXPECT_LT(found.visible_fraction, 0.45);
  EXPECT_GT(found.visible_fraction, 0.25);
  const cv::Mat1f weights = aligner.weights();
  EXPECT_EQ(cv::countNonZero(weights(cv::Rect(4, 4, 40, 100))), 0);
}

TEST_F(RegionAlignerTest, WhatIsInterruptedGoesOnAtItsLevelAndSaysNothingBefore) {
  const Eigen::Matrix3d truth = test::randomHomography(kRoi, 5.0, rng_);
  const cv::Mat image = test::view(scene_, truth, 1.0, 0.0, 1.0, 3);
  RegionAligner aligner = alignerOn(scene_);
  EsmState state;
  AlignmentLimits limits;
  limits.most_work = 0.5;
  int parts = 0;
  Alignment found;
  do {
    aligner.startAfresh();
    found = aligner.align(image, state, nullptr, 32.0, limits);
    state = found.esm.state;
    limits.coarsest = found.esm.level;
    if (found.esm.status == EsmStatus::kInterrupted) {
      EXPECT_EQ(found.visible_fraction, 0.0);
      EXPECT_EQ(found.blocks.seen, 0);
    }
  } while (found.esm.status == EsmStatus::kInterrupted && ++parts < 10);
  EXPECT_GE(parts, 1);
  EXPECT_LT(parts, 10);
  EXPECT_LT(geometry::cornerDistance(state.g, truth, kRoi), 0.3);
}

TEST_F(RegionAlignerTest, DrawsWhatIsCoveredWhereTheImageShowsIt) {
  cv::Mat image = scene_.clone();
  image(cv::Rect(100, 80, 60, 110)).setTo(cv::Scalar(190, 190, 190));
  RegionAligner aligner = alignerOn(scene_);
  EXPECT_EQ(cv::countNonZero(aligner.occlusionMask(Eigen::Matrix3d::Identity(), kSize)), 0);
  aligner.align(image, EsmState(), nullptr, 32.0);
  Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();
  shift.topRightCorner<2, 1>() << 30.0, -20.0;
  for (const Eigen::Matrix3d& g : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), shift}) {
    const cv::Mat1b mask = aligner.occlusionMask(g, kSize);
    ASSERT_EQ(mask.size(), kSize);
    const cv::Point by(static_cast<int>(g(0, 2)), static_cast<int>(g(1, 2)));
    EXPECT_EQ(mask(cv::Point(104, 135) + by), 255);
    EXPECT_EQ(mask(cv::Point(215, 135) + by), 0);
    EXPECT_EQ(mask(cv::Point(95, 135) + by), 0);  // beside the ROI
  }
  shift(0, 2) = 1e6;
  EXPECT_EQ(cv::countNonZero(aligner.occlusionMask(shift, kSize)), 0);
}

TEST_F(RegionAlignerTest, SaysThatTheRegionIsOutsideTheImage) {
  RegionAligner aligner = alignerOn(scene_);
  EsmState far;
  far.g(0, 2) = 5000.0;
  const Alignment found = aligner.align(scene_, far, nullptr, 32.0);
  EXPECT_FALSE(found.in_image);
  EXPECT_EQ(found.esm.status, EsmStatus::kOutOfView);
}

TEST_F(RegionAlignerTest, ForgetsWhatHidTheRegionElsewhere) {
  RegionAligner aligner = alignerOn(scene_);
  cv::Mat image = scene_.clone();
  scene_(cv::Rect(10, 10, 120, 60)).copyTo(image(cv::Rect(100, 80, 120, 60)));
  EXPECT_LT(aligner.align(image, EsmState(), nullptr, 12.0).visible_fraction, 0.7);
  EXPECT_LT(aligner.align(scene_, EsmState(), nullptr, 12.0).visible_fraction, 0.7);  // held
  aligner.startAfresh();
  EXPECT_GT(aligner.align(scene_, EsmState(), nullptr, 12.0).visible_fraction, 0.97);
}

// An instrument that lay over a third of the region when it was selected, and stays while the tissue slides under it:
// the region is where most of it is.
TEST_F(RegionAlignerTest, WhatStandsStillDoesNotHoldTheRestThatHasMovedFar) {
  const auto withInstrument = [&](double shift) {
    Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
    g(0, 2) = shift;
    cv::Mat image = test::view(scene_, g);
    test::tissue(cv::Size(46, 110), 77).copyTo(image(cv::Rect(174, 80, 46, 110)));
    return image;
  };
  for (const double shift : {-13.0, 13.0}) {
    RegionAligner aligner = alignerOn(withInstrument(0.0));
    const Alignment found = aligner.align(withInstrument(shift), EsmState(), nullptr, 32.0);
    const double u = geometry::apply(found.esm.state.g, Eigen::Vector2d(135.0, 135.0)).x();  // on the tissue
    EXPECT_NEAR(u, 135.0 + shift, 2.0);
    EXPECT_LT(found.blocks.off, 2.5);
  }
}

// Reflections on wet tissue, of which each block of a large region holds one, move otherwise than the tissue does.
// Smaller blocks tell, most of which hold none.
TEST_F(RegionAlignerTest, OnALargeRegionReflectionsDoNotTakeTheBlocksWithThem) {
  const cv::Size size(640, 600);
  const geometry::Rectangle roi = {130, 110, 380, 360};
  const cv::Mat tissue = cv::min(0.5 * test::tissue(size, 31) + cv::Scalar(40, 40, 60), 200);
  const auto wet = [&](const cv::Point& by) {
    cv::RNG places(5);
    cv::Mat image = tissue.clone();
    for (int y = 40; y < size.height; y += 88) {
      for (int x = 40; x < size.width; x += 88) {
        const cv::Point at(x + places.uniform(-16, 17), y + places.uniform(-16, 17));
        cv::ellipse(image, at + by, {places.uniform(8, 14), places.uniform(6, 10)}, places.uniform(0, 180), 0, 360,
                    cv::Scalar(225, 230, 240), cv::FILLED, cv::LINE_AA);
      }
    }
    return image;
  };
  for (const cv::Point& by : {cv::Point(10, 6), cv::Point(-8, 10), cv::Point(14, -4)}) {
    RegionAligner aligner(config_);
    aligner.setReference(wet({0, 0}), roi);
    const Alignment found = aligner.align(wet(by), EsmState(), nullptr, 32.0);
    EXPECT_LT(geometry::cornerDistance(found.esm.state.g, Eigen::Matrix3d::Identity(), roi), 2.0) << by;
    EXPECT_LT(found.blocks.off, 1.0) << by;
  }
}

TEST(FinestScale, IsTheLeastThatLeavesFewEnoughPixels) {
  EXPECT_EQ(finestScale({0, 0, 220, 340}), 1);
  EXPECT_EQ(finestScale({0, 0, 400, 500}), 1);
  EXPECT_EQ(finestScale({0, 0, 401, 500}), 2);
  EXPECT_EQ(finestScale({0, 0, 800, 1000}), 2);
  EXPECT_EQ(finestScale({0, 0, 3840, 2160}), 8);
}

// The same region with more pixels: from 447 px on its finest level is coarser than the image. What is found, what is
// covered and what is claimed are the same shares of the region.
TEST(RegionAlignerOfLargeRegions, FindsCoversAndClaimsAlikeAtAnySize) {
  const cv::Mat small = cv::min(test::tissue(cv::Size(240, 200), 22), 240);
  double claimed_once = 0.0;
  for (const int size : {1, 2, 5, 9}) {
    SCOPED_TRACE(size);
    cv::Mat scene;
    cv::resize(small, scene, cv::Size(), size, size, cv::INTER_CUBIC);
    const geometry::Rectangle roi = {60.0 * size, 50.0 * size, 110.0 * size, 100.0 * size};
    RegionAligner aligner{TrackerConfig()};
    aligner.setReference(scene, roi);
    EXPECT_EQ(aligner.esm().level(0).scale, size <= 2 ? 1 : size <= 5 ? 2 : 4);
    EXPECT_LT(aligner.referenceTexture().corner_error, 0.5 * size);
    cv::RNG rng(5);
    double error = 0.0, claimed = 0.0;
    constexpr int kTrials = 6;
    for (int trial = 0; trial < kTrials; ++trial) {
      const Eigen::Matrix3d truth = test::randomHomography(roi, 3.0 * size, rng);
      cv::Mat image = test::view(scene, truth, 1.1, -5.0, 3.0, 40 + trial);
      image(cv::Rect(60 * size, 50 * size, 40 * size, 100 * size)).setTo(cv::Scalar(190, 190, 190));
      const Alignment found = aligner.align(image, EsmState(), nullptr, 32.0 * size);
      const double off = geometry::cornerDistance(found.esm.state.g, truth, roi) / size;
      EXPECT_LT(off, 0.6);
      EXPECT_NEAR(found.visible_fraction, 0.62, 0.06);
      EXPECT_NEAR(found.esm.state.gain, 1.0 / 1.1, 0.03);
      error += off * off / kTrials;
      claimed += std::pow(found.esm.corner_error / size, 2) / kTrials;
    }
    // cornerDistance is of the worst corner, which is 1.5 times what a corner that is expected worst has.
    EXPECT_LT(std::sqrt(error), 2.0 * std::sqrt(claimed));
    EXPECT_GT(std::sqrt(error), 0.3 * std::sqrt(claimed));
    if (size == 1) claimed_once = claimed;
    EXPECT_LT(claimed, claimed_once * 1.1 + 1e-9);  // with more pixels it is known no worse
  }
}

}  // namespace
}  // namespace laparoscope_servo::tracking
