#include "tracking/occlusion/occlusion_gates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "support/synthetic_tissue.h"

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
  int observe(OcclusionGates& gates, const image::Patch& image) const {
    const PatchPair pair = {&image, &grey_};
    return gates.observeStructure(&pair, 1, all_, 1.0, 2.0);
  }
  static int occludedIn(const OcclusionGates& gates) {
    int n = 0;
    for (int area = 0; area < gates.grid().count(); ++area) n += gates.occluded(area);
    return n;
  }
};

TEST_F(OcclusionGatesTest, LetEverythingThroughOnTheReference) {
  OcclusionGates gates(config_, 250);
  gates.setReference(seen(patch_), kSize);
  gates.observeColour(seen(patch_));
  EXPECT_TRUE(gates.colourUsed());
  EXPECT_EQ(observe(gates, grey_), 0);
  EXPECT_EQ(occludedIn(gates), 0);
  EXPECT_EQ(cv::countNonZero(gates.weights().view() < 1.0f), 0);
}

TEST_F(OcclusionGatesTest, WeighWhatIsSaturatedOrInvalidWithNothing) {
  patch_.at<cv::Vec3b>(70, 70) = {255, 255, 255};
  OcclusionGates gates(config_, 250);
  gates.setReference(seen(patch_), kSize);
  cv::Mat current = patch_.clone();
  current.at<cv::Vec3b>(20, 20) = {255, 255, 255};
  valid_(100, 100) = 0;
  gates.observeColour(seen(current));
  const cv::Mat1f w = gates.weights().view();
  EXPECT_EQ(w(70, 70), 0.0f);
  EXPECT_EQ(w(72, 68), 0.0f);
  EXPECT_EQ(w(20, 20), 0.0f);
  EXPECT_EQ(w(100, 100), 0.0f);
  EXPECT_EQ(w(50, 50), 1.0f);
  EXPECT_EQ(cv::countNonZero(w < 1.0f), 25 + 25 + 1);
}

TEST_F(OcclusionGatesTest, TheColourGateDecidesAfreshInEachImage) {
  OcclusionGates gates(config_, 256);
  gates.setReference(seen(patch_), kSize);
  cv::Mat current = patch_.clone();
  current(cv::Rect(0, 0, 10, 10)).setTo(cv::Scalar(200, 200, 200));
  gates.observeColour(seen(current));
  EXPECT_TRUE(gates.occluded(0));
  EXPECT_GT(gates.distances()[0], 0.5f);
  EXPECT_EQ(gates.weights()(5, 5), 0.0f);
  gates.observeColour(seen(patch_));
  EXPECT_FALSE(gates.occluded(0));
}

// A lamp that comes nearer clips what was bright already: that is no occluder.
TEST_F(OcclusionGatesTest, WhatClipsIsNoOccluder) {
  cv::Mat3b reference(kSize), brighter(kSize);
  for (int j = 0; j < kSize.height; ++j) {
    for (int i = 0; i < kSize.width; ++i) {
      const double level = 80 + (i * 7 + j * 13) % 60;
      reference(j, i) = cv::Vec3b(cv::saturate_cast<uchar>(0.6 * level), cv::saturate_cast<uchar>(0.6 * level),
                                  cv::saturate_cast<uchar>(2.0 * level));
      brighter(j, i) = reference(j, i) * 1.6;
    }
  }
  OcclusionGates gates(config_, 250);
  gates.setReference(seen(reference), kSize);
  ColourHistograms before(ColourGate::kNormalised, config_.bins), now(ColourGate::kNormalised, config_.bins);
  before.compute(seen(reference), gates.grid());
  now.compute(seen(brighter), gates.grid());
  std::vector<float> distances;
  areaDistances(before, now, gates.grid(), config_.bins, distances);
  EXPECT_GT(std::count_if(distances.begin(), distances.end(), [&](float d) { return d > config_.threshold; }), 150);
  gates.observeColour(seen(brighter));
  EXPECT_EQ(occludedIn(gates), 0);
  for (const float d : gates.distances()) EXPECT_LE(d, config_.threshold);
}

// Blue, green, red.
struct LightOfAll {
  cv::Scalar gain, offset;
};
const LightOfAll kLights[] = {{{0.8, 1.0, 1.2}, {}},
                              {{1.2, 1.0, 0.8}, {}},
                              {{0.9, 1.0, 1.1}, {}},
                              {{0.67, 0.67, 0.67}, {73, 73, 73}},
                              {{0.5, 0.5, 0.5}, {110, 110, 110}},
                              {{0.6, 0.5, 0.4}, {60, 60, 60}}};

cv::Mat relit(const cv::Mat& image, const LightOfAll& light) {
  cv::Mat result;
  image.convertTo(result, CV_32F);
  cv::multiply(result, light.gain, result);
  result += light.offset;
  result.convertTo(result, CV_8U);
  return result;
}

TEST_F(OcclusionGatesTest, WhiteBalanceAndAVeilLeaveTheDistancesWhereTheyWere) {
  patch_ = cv::min(patch_, 200);
  for (const LightOfAll& light : kLights) {
    OcclusionGates gates(config_, 250);
    gates.setReference(seen(patch_), kSize);
    gates.observeColour(seen(relit(patch_, light)));
    EXPECT_EQ(occludedIn(gates), 0) << light.gain << light.offset;
    for (const float d : gates.distances()) EXPECT_LT(d, 0.4) << light.gain << light.offset;
    EXPECT_NEAR(gates.lightGain() * cv::sum(light.gain)[0] / 3.0, 1.0, 0.25);
  }
}

TEST_F(OcclusionGatesTest, AnOccluderOfAnotherColourKeepsItsDistance) {
  patch_ = cv::min(patch_, 200);
  for (const cv::Scalar& colour : {cv::Scalar(140, 140, 140), cv::Scalar(90, 150, 70), cv::Scalar(200, 200, 210)}) {
    for (const int rows : {8, 11}) {  // of 14: 57 and 79 %
      cv::Mat covered = patch_.clone();
      covered.rowRange(0, 10 * rows).setTo(colour);
      OcclusionGates gates(config_, 250);
      gates.setReference(seen(patch_), kSize);
      gates.observeColour(seen(covered));
      EXPECT_EQ(occludedIn(gates), 14 * rows) << colour;
      EXPECT_EQ(gates.lightGain(), 0.0);
    }
  }
}

TEST_F(OcclusionGatesTest, ALightIsKnownOnceWhatItLetThroughLooksLikeTheReference) {
  patch_ = cv::min(patch_, 200);
  const LightOfAll& light = kLights[0];
  cv::Mat covered = relit(patch_, light);
  covered.rowRange(0, 110).setTo(cv::Scalar(140, 140, 140));
  image::Patch other = grey_;
  cv::Mat1f turned;
  cv::flip(grey_.view(), turned, -1);
  turned.copyTo(other.view());
  for (const bool alike : {true, false}) {
    OcclusionGates gates(config_, 250);
    gates.setReference(seen(patch_), kSize);
    gates.observeColour(seen(relit(patch_, light)));
    observe(gates, alike ? grey_ : other);
    for (int image = 0; image <= config_.hold; ++image) gates.advance();
    gates.observeColour(seen(covered));
    int free = 0;
    for (int area = 11 * 14; area < gates.grid().count(); ++area) free += !gates.occluded(area);
    if (alike) {
      EXPECT_EQ(free, 3 * 14);
    } else {
      EXPECT_EQ(gates.lightGain(), 0.0);
    }
    EXPECT_TRUE(gates.occluded(0));
  }
}

// Red alone says nothing of a mixture of blue and green.
TEST_F(OcclusionGatesTest, AChannelThatIsNotTrackedMayClip) {
  cv::Mat current = patch_.clone();
  for (int j = 0; j < 40; ++j) {
    for (int i = 0; i < kSize.width; ++i) current.at<cv::Vec3b>(j, i)[2] = 255;
  }
  current.at<cv::Vec3b>(100, 100) = {255, 255, 255};
  config_.colour = ColourGate::kNone;
  for (const bool red : {true, false}) {
    OcclusionGates gates(config_, 250);
    gates.setReference(seen(patch_), kSize, {true, true, red});
    gates.observeColour(seen(current));
    EXPECT_EQ(cv::countNonZero(gates.weights().view() < 1.0f), 25 + (red ? 42 * kSize.width : 0));
  }
}

TEST_F(OcclusionGatesTest, RefuseAPatchThatIsNotSampledAsTheyNeedIt) {
  OcclusionGates gates(config_, 250);
  EXPECT_THROW(gates.setReference(seen(patch_), cv::Size(450, 450)), std::invalid_argument);
  EXPECT_THROW(gates.setReference(seen(patch_), cv::Size(141, 140)), std::invalid_argument);
}

TEST_F(OcclusionGatesTest, TheStructureGateHoldsForTheConfiguredImages) {
  config_.hold = 2;
  OcclusionGates gates(config_, 256);
  gates.setReference(seen(patch_), kSize);
  image::Patch other = grey_;
  cv::Mat1f turned;
  cv::flip(grey_.view(), turned, -1);
  turned(cv::Rect(0, 0, 10, 10)).copyTo(other.view()(cv::Rect(0, 0, 10, 10)));
  EXPECT_EQ(observe(gates, other), 1);
  EXPECT_EQ(observe(gates, other), 0);  // known already
  for (int image = 0; image <= config_.hold; ++image) {
    EXPECT_TRUE(gates.occluded(0)) << image;
    gates.advance();
  }
  EXPECT_FALSE(gates.occluded(0));
  observe(gates, other);
  gates.forget();
  EXPECT_EQ(occludedIn(gates), 0);
}

TEST_F(OcclusionGatesTest, SayWhyAnAreaIsHidden) {
  OcclusionGates gates(config_, 250);
  gates.setReference(seen(patch_), kSize);
  AreaReport areas;
  gates.report(areas);
  const std::vector<AreaCause>& causes = areas.cause;
  EXPECT_EQ(causes, std::vector<AreaCause>(gates.grid().count(), AreaCause::kNone)) << "before the first image";

  const auto area = [&](int i, int j) { return static_cast<std::size_t>(gates.grid().areaOf(i, j)); };
  cv::Mat current = patch_.clone();
  current(cv::Rect(0, 0, 30, 30)) = cv::Scalar(200, 120, 20);
  current(cv::Rect(40, 40, 20, 20)) = cv::Scalar(255, 255, 255);
  current(cv::Rect(15, 60, 3, 1)) = cv::Scalar(255, 255, 255);  // grows to 7 x 5 px: less than half of an area
  valid_(cv::Rect(100, 0, 40, 140)) = 0;
  gates.observeColour(seen(current));
  image::Patch other = grey_;
  cv::Mat part = other.view()(cv::Rect(60, 100, 20, 20));
  cv::randu(part, 0, 255);
  observe(gates, other);
  gates.report(areas);
  EXPECT_EQ(areas.rows * areas.columns, gates.grid().count());
  EXPECT_EQ(areas.distance.size(), causes.size());
  EXPECT_EQ(causes[area(12, 12)], AreaCause::kColour);
  EXPECT_EQ(causes[area(45, 45)], AreaCause::kHighlight);
  EXPECT_EQ(causes[area(16, 60)], AreaCause::kNone);
  EXPECT_EQ(causes[area(105, 70)], AreaCause::kBorder);
  EXPECT_EQ(causes[area(65, 105)], AreaCause::kStructure);
  EXPECT_EQ(causes[area(80, 80)], AreaCause::kNone);
  for (std::size_t k = 0; k < causes.size(); ++k) {
    const bool decided = causes[k] == AreaCause::kColour || causes[k] == AreaCause::kStructure;
    EXPECT_LE(decided, gates.occluded(static_cast<int>(k)));
    EXPECT_LE(gates.occluded(static_cast<int>(k)), causes[k] != AreaCause::kNone);
    EXPECT_EQ(areas.occluded[k], gates.covered(static_cast<int>(k)));
  }
}

TEST_F(OcclusionGatesTest, StandAsideWithoutColour) {
  OcclusionGates gates(config_, 256);
  cv::Mat mono;
  cv::cvtColor(patch_, mono, cv::COLOR_BGR2GRAY);
  gates.setReference(seen(mono), kSize);
  gates.observeColour(seen(mono));
  EXPECT_FALSE(gates.colourUsed());
  EXPECT_EQ(occludedIn(gates), 0);
  EXPECT_TRUE(std::isnan(gates.distances()[0]));
  gates.setReference(seen(patch_), kSize);  // a colour reference, then a mono image
  gates.observeColour(seen(mono));
  EXPECT_FALSE(gates.colourUsed());
}

TEST_F(OcclusionGatesTest, BothCanBeTurnedOff) {
  config_.colour = ColourGate::kNone;
  config_.structure = false;
  OcclusionGates gates(config_, 256);
  gates.setReference(seen(patch_), kSize);
  gates.observeColour(seen(cv::Mat(kSize, CV_8UC3, cv::Scalar(200, 200, 200))));
  EXPECT_EQ(observe(gates, patchOf(255.0 - grey_.view())), 0);
  EXPECT_EQ(occludedIn(gates), 0);
}

TEST_F(OcclusionGatesTest, CorrelateWhatIsVisibleWithoutItsShading) {
  OcclusionGates gates(config_, 256);
  gates.setReference(seen(patch_), kSize);
  EXPECT_EQ(gates.correlation(), 0.0);  // nothing observed yet
  EXPECT_EQ(gates.visibleFraction(), 0.0);
  cv::Mat1f shaded = grey_.view().clone();
  shaded(cv::Rect(0, 0, 70, 140)) -= 40.0f;
  observe(gates, patchOf(shaded));
  EXPECT_NEAR(gates.correlation(), 1.0, 1e-3);
  EXPECT_NEAR(gates.visibleFraction(), 1.0, 1e-6);
  cv::Mat current = patch_.clone();
  current(cv::Rect(0, 0, 70, 140)).setTo(cv::Scalar(200, 200, 200));
  gates.observeColour(seen(current));
  observe(gates, grey_);
  EXPECT_NEAR(gates.visibleFraction(), 0.5, 1e-6);
  gates.observeColour(seen(patch_));
  config_.structure = false;
  OcclusionGates blind(config_, 256);  // without the gate, unrelated texture shows in the correlation
  blind.setReference(seen(patch_), kSize);
  cv::Mat1f turned;
  cv::flip(grey_.view(), turned, -1);
  observe(blind, patchOf(turned));
  EXPECT_LT(std::abs(blind.correlation()), 0.3);
}

// A region with more pixels than its histograms need is sampled: the pixels between follow their sample.
TEST_F(OcclusionGatesTest, SampleLargeRegions) {
  const cv::Size size(449, 450);
  ASSERT_EQ(samplingStep(size, config_), 2);
  EXPECT_EQ(samplingStep(kSize, config_), 1);
  const cv::Mat image = cv::min(test::tissue(size, 4), 240);
  const auto sampled = [&](const cv::Mat& whole) {
    image::ColourPatch patch;
    image::warpNearest(whole, Eigen::Vector3d(2.0, 2.0, 1.0).asDiagonal(), cv::Size(225, 225), patch);
    return patch;
  };
  OcclusionGates gates(config_, 250);
  gates.setReference(sampled(image), size);
  cv::Mat current = image.clone();
  current(cv::Rect(0, 0, 33, 33)).setTo(cv::Scalar(200, 200, 200));  // the first area, and a pixel of the next
  current(cv::Rect(300, 301, 2, 2)).setTo(cv::Scalar(255, 255, 255));
  gates.observeColour(sampled(current));
  EXPECT_TRUE(gates.occluded(0));
  EXPECT_EQ(occludedIn(gates), 1);
  const cv::Mat1f w = gates.weights().view();
  EXPECT_EQ(cv::countNonZero(w(cv::Rect(0, 0, 32, 32))), 0);
  EXPECT_EQ(w(301, 300), 0.0f);  // a highlight, grown
  EXPECT_EQ(w(303, 302), 0.0f);
  EXPECT_EQ(w(310, 300), 1.0f);
  EXPECT_EQ(w(449, 448), 1.0f);  // the last pixel has a sample, too
}

TEST_F(OcclusionGatesTest, RefuseARegionWithFewerPixelsThanAreas) {
  OcclusionGates gates(config_, 256);
  EXPECT_THROW(gates.setReference(seen(patch_(cv::Rect(0, 0, 10, 50))), cv::Size(10, 50)), std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
