#include "tracking/align/channel_choice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

constexpr int kSaturation = 250;
const cv::Size kSize(120, 100);

// Each channel's own texture of so much contrast around its level.
cv::Mat textured(const cv::Scalar& level, const cv::Scalar& contrast) {
  std::vector<cv::Mat> planes;
  for (int c = 0; c < 3; ++c) {
    cv::Mat1f noise(kSize);
    cv::RNG(7).fill(noise, cv::RNG::NORMAL, 0.0, 1.0);  // the same in all channels
    cv::GaussianBlur(noise, noise, cv::Size(), 2.0);
    planes.emplace_back();
    cv::Mat(noise * (7.0 * contrast[c]) + level[c]).convertTo(planes.back(), CV_8U);
  }
  cv::Mat result;
  cv::merge(planes, result);
  return result;
}

image::ChannelWeights strongest(const cv::Mat& image, int saturation = kSaturation) {
  const image::Channels chosen = chosenChannels(TrackedChannels::kStrongest, image, saturation);
  EXPECT_EQ(chosen.count, 1);
  const image::ChannelWeights w = chosen.weights[0];
  EXPECT_NEAR(std::abs(w[0]) + std::abs(w[1]) + std::abs(w[2]), 1.0f, 1e-5f);
  return w;
}

TEST(ChosenChannels, TheStrongestMixtureGoesByContrast) {
  const image::ChannelWeights w = strongest(textured({60, 60, 60}, {10, 5, 5}));
  EXPECT_NEAR(w[0], 0.5f, 0.05f);
  EXPECT_NEAR(w[1], 0.25f, 0.05f);
  EXPECT_NEAR(w[2], 0.25f, 0.05f);
}

TEST(ChosenChannels, WhatClipsHasNoPartInIt) {
  const cv::Mat image = textured({80, 90, 300}, {8, 8, 30});  // red is at its limit nearly everywhere
  const image::ChannelWeights w = strongest(image);
  EXPECT_EQ(w[2], 0.0f);
  EXPECT_GT(w[0], 0.4f);
  EXPECT_EQ(coloursIn(chosenChannels(TrackedChannels::kStrongest, image, kSaturation)),
            (std::array<bool, 3>{true, true, false}));
  EXPECT_GT(strongest(image, 256)[2], 0.05f);
}

// A brighter lamp would take red to its limit, and all that is tracked with it. That is not worth what red has to say.
TEST(ChosenChannels, WhatIsAboutToClipHasNoneEither) {
  EXPECT_EQ(strongest(textured({60, 70, 210}, {8, 8, 1}))[2], 0.0f);
  EXPECT_GT(strongest(textured({60, 70, 210}, {8, 8, 8}))[2], 0.3f);
  EXPECT_GT(strongest(textured({60, 70, 80}, {8, 8, 1}))[2], 0.03f);
}

TEST(ChosenChannels, InColourAChannelThatClipsIsLeftOut) {
  const auto count = [](const cv::Mat& image) {
    return chosenChannels(TrackedChannels::kColour, image, kSaturation).count;
  };
  EXPECT_EQ(count(textured({80, 90, 160}, {8, 8, 8})), 3);
  const cv::Mat clipped = textured({80, 90, 300}, {8, 8, 8});
  const image::Channels two = chosenChannels(TrackedChannels::kColour, clipped, kSaturation);
  EXPECT_EQ(two.count, 2);
  EXPECT_EQ(coloursIn(two), (std::array<bool, 3>{true, true, false}));
}

TEST(ChosenChannels, AreLumaWhereThereIsNothingToChoose) {
  const auto isLuma = [](const image::Channels& channels) {
    return channels.count == 1 && channels.weights[0] == image::kLuma;
  };
  const cv::Mat image = textured({80, 90, 160}, {8, 8, 8});
  EXPECT_TRUE(isLuma(chosenChannels(TrackedChannels::kLuma, image, kSaturation)));
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  EXPECT_TRUE(isLuma(chosenChannels(TrackedChannels::kStrongest, grey, kSaturation)));
  EXPECT_TRUE(isLuma(chosenChannels(TrackedChannels::kStrongest, cv::Mat(kSize, CV_8UC3, cv::Scalar::all(90)), 250)));
  EXPECT_EQ(coloursIn(image::kLuma), (std::array<bool, 3>{true, true, true}));
}

}  // namespace
}  // namespace laparoscope_servo::tracking
