#include "tracking/align/region_aligners.h"

#include <gtest/gtest.h>

#include <array>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "tracking/align/channel_choice.h"

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi{30.0, 20.0, 120.0, 100.0};

// The same texture in all channels, around a level of each.
cv::Mat tissue(const cv::Scalar& level = {90, 100, 170}) {
  cv::Mat1f noise(160, 200);
  cv::RNG(3).fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
  cv::GaussianBlur(noise, noise, cv::Size(), 2.0);
  std::vector<cv::Mat> planes(3);
  for (int c = 0; c < 3; ++c) cv::Mat(noise * 100.0 + level[c]).convertTo(planes[c], CV_8U);
  cv::Mat image;
  cv::merge(planes, image);
  return image;
}

cv::Mat brighter(const cv::Mat& image, double gain) {
  cv::Mat result;
  image.convertTo(result, CV_8U, gain);
  return result;
}

RegionAligners onTissue(const cv::Mat& image) {
  RegionAligners aligners{TrackerConfig()};
  aligners.usual().setReference(image, kRoi);
  aligners.setBright(image);
  return aligners;
}

TEST(RegionAligners, TheUsualColoursAreTrackedInTheLightOfTheReference) {
  const cv::Mat image = tissue();
  RegionAligners aligners = onTissue(image);
  EXPECT_TRUE(coloursIn(aligners.now().channels())[2]);
  aligners.choose(image, EsmState());
  EXPECT_EQ(&aligners.now(), &aligners.usual());
  EXPECT_FALSE(aligners.turnBright(brighter(image, 0.5), Eigen::Matrix3d::Identity()));
  aligners.choose(brighter(image, 0.5), EsmState());
  EXPECT_EQ(&aligners.now(), &aligners.usual());
}

TEST(RegionAligners, WhereRedClipsTheOthersAreTrackedAndFindTheRegion) {
  const cv::Mat image = tissue();
  RegionAligners aligners = onTissue(image);
  const cv::Mat bright = brighter(image, 1.6);
  const EsmState start = aligners.choose(bright, EsmState());
  ASSERT_NE(&aligners.now(), &aligners.usual());
  EXPECT_EQ(coloursIn(aligners.now().channels()), (std::array<bool, 3>{true, true, false}));
  const Alignment found = aligners.now().align(bright, start, nullptr, 20.0);
  EXPECT_EQ(found.esm.status, EsmStatus::kConverged);
  EXPECT_LT(geometry::cornerDistance(found.esm.state.g, Eigen::Matrix3d::Identity(), kRoi), 0.1);
  EXPECT_GT(found.visible_fraction, 0.8);
  aligners.choose(image, EsmState());
  EXPECT_EQ(&aligners.now(), &aligners.usual());
}

TEST(RegionAligners, WhereRedClipsInSomeOfItTheUsualColoursAreTrackedUntilTheyAreNotRight) {
  const cv::Mat image = tissue();
  const cv::Mat bright = brighter(image, 1.45);  // red clips in four of ten pixels
  RegionAligners aligners = onTissue(image);
  const EsmState start = aligners.choose(bright, EsmState());
  EXPECT_EQ(&aligners.now(), &aligners.usual());
  EXPECT_TRUE(aligners.turnBright(bright, start.g));
  EXPECT_FALSE(aligners.turnBright(bright, start.g));  // it has turned
  aligners.choose(bright, start);
  EXPECT_NE(&aligners.now(), &aligners.usual());
}

TEST(RegionAligners, AnAlignerOfTheLastImagesHasItsOwnLightAndIsChosenAtOnce) {
  const cv::Mat image = tissue();
  const cv::Mat bright = brighter(image, 1.45);
  RegionAligners aligners = onTissue(image);
  EsmState accepted;
  accepted.gain = 1.5;
  aligners.remember(accepted);
  aligners.advance();
  EsmState last;
  last.gain = 0.6;
  ASSERT_TRUE(aligners.turnBright(bright, last.g));
  EXPECT_EQ(aligners.choose(bright, last).gain, 0.6);  // it has none
  aligners.remember(last);
  aligners.advance();
  EXPECT_EQ(aligners.choose(image, last).gain, 1.5);
  EXPECT_EQ(aligners.choose(bright, accepted).gain, 0.6);
  EXPECT_NE(&aligners.now(), &aligners.usual());
  aligners.choose(image, last);
  aligners.remember(accepted);
  for (int k = 0; k <= OcclusionConfig().hold; ++k) aligners.advance();
  aligners.choose(bright, accepted);
  EXPECT_EQ(&aligners.now(), &aligners.usual());  // too long ago
  ASSERT_TRUE(aligners.turnBright(bright, accepted.g));
  EXPECT_EQ(aligners.choose(bright, accepted).gain, 1.5);
}

TEST(RegionAligners, ThereIsOneWhereNoOtherColoursAreBetterOrThereAreNone) {
  for (const cv::Mat& image : {tissue({60, 70, 80}), cv::Mat(tissue().reshape(1).colRange(0, 200).clone())}) {
    RegionAligners aligners = onTissue(image);
    EXPECT_FALSE(aligners.turnBright(brighter(image, 3.0), Eigen::Matrix3d::Identity()));
    aligners.choose(brighter(image, 3.0), EsmState());
    EXPECT_EQ(&aligners.now(), &aligners.usual());
  }
}

}  // namespace
}  // namespace laparoscope_servo::tracking
