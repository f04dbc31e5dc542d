#include "tracking/align/region_aligner.h"

#include <gtest/gtest.h>

#include <limits>

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

}  // namespace
}  // namespace laparoscope_servo::tracking
