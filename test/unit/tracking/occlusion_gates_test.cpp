#include "laparoscope_servo/tracking/occlusion_gates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "../../support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(140, 140);

class OcclusionGatesTest : public ::testing::Test {
 protected:
  cv::Mat patch_ = cv::min(test::tissue(kSize, 4), 240);
  cv::Mat1b valid_{kSize, 255};
  image::Patch grey_, all_;
  OcclusionConfig config_;

  static image::Patch patchOf(const cv::Mat1f& image) {
    image::Patch patch;
    patch.resize(image.cols, image.rows);
    image.copyTo(patch.view());
    return patch;
  }
  void SetUp() override {
    cv::Mat luma;
    cv::cvtColor(patch_, luma, cv::COLOR_BGR2GRAY);
    luma.convertTo(luma, CV_32F);
    grey_ = patchOf(luma);
    all_ = patchOf(cv::Mat1f::ones(kSize));
  }
  image::ColourPatch seen(const cv::Mat& image) const {
    image::ColourPatch patch;
    image::warpNearest(image, Eigen::Matrix3d::Identity(), image.size(), patch);
    patch.valid &= valid_(cv::Rect(0, 0, image.cols, image.rows));
    return patch;
  }
  static int occludedIn(const OcclusionGates& gates) {
    int n = 0;
    for (int area = 0; area < gates.grid().count(); ++area) n += gates.occluded(area);
    return n;
  }
};

TEST_F(OcclusionGatesTest, LetEverythingThroughOnTheReference) {
  OcclusionGates gates(config_, 250);
  gates.setReference(seen(patch_));
  gates.observeColour(seen(patch_));
  EXPECT_TRUE(gates.colourUsed());
  EXPECT_EQ(gates.observeStructure(grey_, grey_, all_, 1.0, 2.0), 0);
  EXPECT_EQ(occludedIn(gates), 0);
  EXPECT_EQ(cv::countNonZero(gates.weights() < 1.0f), 0);
}

TEST_F(OcclusionGatesTest, WeighWhatIsSaturatedOrInvalidWithNothing) {
  patch_.at<cv::Vec3b>(70, 70) = {255, 255, 255};
  OcclusionGates gates(config_, 250);
  gates.setReference(seen(patch_));
  cv::Mat current = patch_.clone();
  current.at<cv::Vec3b>(20, 20) = {255, 255, 255};
  valid_(100, 100) = 0;
  gates.observeColour(seen(current));
  const cv::Mat1f& w = gates.weights();
  EXPECT_EQ(w(70, 70), 0.0f);
  EXPECT_EQ(w(72, 68), 0.0f);
  EXPECT_EQ(w(20, 20), 0.0f);
  EXPECT_EQ(w(100, 100), 0.0f);
  EXPECT_EQ(w(50, 50), 1.0f);
  EXPECT_EQ(cv::countNonZero(w < 1.0f), 25 + 25 + 1);
}

TEST_F(OcclusionGatesTest, TheColourGateDecidesAfreshInEachImage) {
  OcclusionGates gates(config_, 256);
  gates.setReference(seen(patch_));
  cv::Mat current = patch_.clone();
  current(cv::Rect(0, 0, 10, 10)).setTo(cv::Scalar(200, 200, 200));
  gates.observeColour(seen(current));
  EXPECT_TRUE(gates.occluded(0));
  EXPECT_GT(gates.distances()[0], 0.5f);
  EXPECT_EQ(gates.weights()(5, 5), 0.0f);
  gates.observeColour(seen(patch_));
  EXPECT_FALSE(gates.occluded(0));
}

TEST_F(OcclusionGatesTest, TheStructureGateHoldsForTheConfiguredImages) {
  config_.hold = 2;
  OcclusionGates gates(config_, 256);
  gates.setReference(seen(patch_));
  image::Patch other = grey_;
  cv::Mat1f turned;
  cv::flip(grey_.view(), turned, -1);
  turned(cv::Rect(0, 0, 10, 10)).copyTo(other.view()(cv::Rect(0, 0, 10, 10)));
  EXPECT_EQ(gates.observeStructure(other, grey_, all_, 1.0, 2.0), 1);
  EXPECT_EQ(gates.observeStructure(other, grey_, all_, 1.0, 2.0), 0);  // known already
  for (int image = 0; image <= config_.hold; ++image) {
    EXPECT_TRUE(gates.occluded(0)) << image;
    gates.advance();
  }
  EXPECT_FALSE(gates.occluded(0));
  gates.observeStructure(other, grey_, all_, 1.0, 2.0);
  gates.forget();
  EXPECT_EQ(occludedIn(gates), 0);
}

TEST_F(OcclusionGatesTest, StandAsideWithoutColour) {
  OcclusionGates gates(config_, 256);
  cv::Mat mono;
  cv::cvtColor(patch_, mono, cv::COLOR_BGR2GRAY);
  gates.setReference(seen(mono));
  gates.observeColour(seen(mono));
  EXPECT_FALSE(gates.colourUsed());
  EXPECT_EQ(occludedIn(gates), 0);
  EXPECT_TRUE(std::isnan(gates.distances()[0]));
  gates.setReference(seen(patch_));  // a colour reference, then a mono image
  gates.observeColour(seen(mono));
  EXPECT_FALSE(gates.colourUsed());
}

TEST_F(OcclusionGatesTest, BothCanBeTurnedOff) {
  config_.colour = ColourGate::kNone;
  config_.structure = false;
  OcclusionGates gates(config_, 256);
  gates.setReference(seen(patch_));
  gates.observeColour(seen(cv::Mat(kSize, CV_8UC3, cv::Scalar(200, 200, 200))));
  EXPECT_EQ(gates.observeStructure(patchOf(255.0 - grey_.view()), grey_, all_, 1.0, 2.0), 0);
  EXPECT_EQ(occludedIn(gates), 0);
}

TEST_F(OcclusionGatesTest, CorrelateWhatIsVisibleWithoutItsShading) {
  OcclusionGates gates(config_, 256);
  gates.setReference(seen(patch_));
  EXPECT_EQ(gates.correlation(), 0.0);  // nothing observed yet
  EXPECT_EQ(gates.visibleFraction(), 0.0);
  cv::Mat1f shaded = grey_.view().clone();
  shaded(cv::Rect(0, 0, 70, 140)) -= 40.0f;
  gates.observeStructure(patchOf(shaded), grey_, all_, 1.0, 2.0);
  EXPECT_NEAR(gates.correlation(), 1.0, 1e-3);
  EXPECT_NEAR(gates.visibleFraction(), 1.0, 1e-6);
  cv::Mat current = patch_.clone();
  current(cv::Rect(0, 0, 70, 140)).setTo(cv::Scalar(200, 200, 200));
  gates.observeColour(seen(current));
  gates.observeStructure(grey_, grey_, all_, 1.0, 2.0);
  EXPECT_NEAR(gates.visibleFraction(), 0.5, 1e-6);
  gates.observeColour(seen(patch_));
  config_.structure = false;
  OcclusionGates blind(config_, 256);  // without the gate, unrelated texture shows in the correlation
  blind.setReference(seen(patch_));
  cv::Mat1f turned;
  cv::flip(grey_.view(), turned, -1);
  blind.observeStructure(patchOf(turned), grey_, all_, 1.0, 2.0);
  EXPECT_LT(std::abs(blind.correlation()), 0.3);
}

TEST_F(OcclusionGatesTest, RefuseARegionWithFewerPixelsThanAreas) {
  OcclusionGates gates(config_, 256);
  EXPECT_THROW(gates.setReference(seen(patch_(cv::Rect(0, 0, 10, 50)))), std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
