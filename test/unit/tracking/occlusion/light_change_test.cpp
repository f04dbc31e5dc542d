#include "tracking/occlusion/light_change.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "support/synthetic_tissue.h"
#include "tracking/occlusion/colour_gate.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(140, 140);
constexpr int kBins = 32;

// Reddish, so that red clips first; `brightest` of red before the gain.
image::ColourPatch tissue(double brightest, double gain, std::uint64_t noise) {
  cv::Mat1f pattern(kSize);
  cv::RNG coarse(3);
  cv::Mat1f small(14, 14);
  coarse.fill(small, cv::RNG::UNIFORM, 0.6, 1.0);
  cv::resize(small, pattern, kSize, 0, 0, cv::INTER_CUBIC);
  cv::RNG rng(noise);
  image::ColourPatch patch;
  patch.has_colour = true;
  patch.valid = cv::Mat1b(kSize, 255);
  for (const auto& [plane, share] :
       {std::tuple{&patch.red, 1.0}, std::tuple{&patch.green, 0.45}, std::tuple{&patch.blue, 0.4}}) {
    cv::Mat1f grain(kSize);
    rng.fill(grain, cv::RNG::NORMAL, 0.0, 2.0);
    cv::Mat(pattern * (brightest * share * gain) + grain).convertTo(*plane, CV_8U);
  }
  return patch;
}

class LightChangeTest : public ::testing::Test {
 protected:
  image::AreaGrid grid_{kSize.width, kSize.height, 14, 14};
  static constexpr ColourLight kSame = {};
  std::vector<float> plain_;

  float clippedDistance(const image::ColourPatch& a, const image::ColourPatch& b, int area) const {
    return LightChange(a, kBins, grid_).clippedDistance(b, kSame, area);
  }
  void comparePlainly(const image::ColourPatch& a, const image::ColourPatch& b) {
    ColourHistograms first(ColourGate::kNormalised, kBins), second(ColourGate::kNormalised, kBins);
    first.compute(a, grid_);
    second.compute(b, grid_);
    areaDistances(first, second, grid_, kBins, plain_);
  }
};

TEST_F(LightChangeTest, AccountsForWhatClippingDoesToColour) {
  const image::ColourPatch reference = tissue(240, 1.0, 1);
  for (double gain : {1.25, 1.5, 1.8}) {
    const image::ColourPatch current = tissue(240, gain, 2);
    LightChange change(reference, kBins, grid_);
    comparePlainly(reference, current);
    int differ = 0, clipped = 0;
    for (int area = 0; area < grid_.count(); ++area) {
      const float distance = change.clippedDistance(current, kSame, area);
      if (std::isnan(distance)) continue;
      ++clipped;
      differ += plain_[area] > 0.5f;
      EXPECT_LT(distance, 0.5f) << "gain " << gain << ", area " << area;
    }
    EXPECT_GT(clipped, 60) << gain;
    if (gain >= 1.5) {
      EXPECT_GT(differ, 100) << gain;
    }
  }
}

TEST_F(LightChangeTest, IsSymmetric) {
  const image::ColourPatch a = tissue(240, 1.0, 1), b = tissue(240, 1.4, 2);
  for (int area = 0; area < grid_.count(); ++area) {
    const float forth = clippedDistance(a, b, area), back = clippedDistance(b, a, area);
    ASSERT_EQ(std::isnan(forth), std::isnan(back));
    if (!std::isnan(forth)) {
      EXPECT_NEAR(forth, back, 1e-5);
    }
  }
}

TEST_F(LightChangeTest, DoesNotExcuseAnOccluderThatClips) {
  const image::ColourPatch reference = tissue(240, 1.0, 1);
  for (const cv::Vec3b& colour : {cv::Vec3b(255, 255, 255), cv::Vec3b(255, 220, 200), cv::Vec3b(120, 255, 120)}) {
    image::ColourPatch sheet = tissue(240, 1.4, 2);
    sheet.blue.setTo(colour[0]);
    sheet.green.setTo(colour[1]);
    sheet.red.setTo(colour[2]);
    LightChange change(reference, kBins, grid_);
    for (int area = 0; area < grid_.count(); ++area) {
      EXPECT_FALSE(change.clippedDistance(sheet, kSame, area) <= 0.5f) << colour << ", area " << area;
    }
  }
}

TEST_F(LightChangeTest, SaysNothingWhereClippingCannotBeTheReason) {
  const auto none = [&](const image::ColourPatch& a, const image::ColourPatch& b) {
    return std::isnan(clippedDistance(a, b, 100));
  };
  const image::ColourPatch bright = tissue(240, 1.6, 1);
  EXPECT_FALSE(none(tissue(240, 1.0, 2), bright));
  EXPECT_TRUE(none(tissue(120, 1.0, 1), tissue(120, 1.4, 2)));  // nothing clips
  EXPECT_TRUE(none(tissue(100, 1.0, 1), bright));               // a gain beyond 2.5
  EXPECT_TRUE(none(tissue(20, 1.0, 1), bright));                // dark
  image::ColourPatch outside = tissue(240, 1.6, 1);
  outside.valid.setTo(0);
  EXPECT_TRUE(none(bright, outside));
  EXPECT_TRUE(none(outside, bright));
}

// A white balance as well, which takes red to its limit: what clips is told from what does not in the image's own
// light.
TEST_F(LightChangeTest, AccountsForClippingInAnotherLight) {
  const image::ColourPatch reference = tissue(230, 1.0, 1);
  image::ColourPatch current = tissue(230, 1.0, 2);
  cv::Mat(current.red * 1.5).copyTo(current.red);
  cv::Mat(current.blue * 0.8).copyTo(current.blue);
  LightChange change(reference, kBins, grid_);
  const ColourLight light = {ChannelLight{1.25f, 0.0f}, ChannelLight(), ChannelLight{1.0f / 1.5f, 0.0f}};
  int clipped = 0;
  for (int area = 0; area < grid_.count(); ++area) {
    const float distance = change.clippedDistance(current, light, area);
    if (std::isnan(distance)) continue;
    ++clipped;
    EXPECT_LT(distance, 0.5f) << area;
    EXPECT_GT(change.clippedDistance(current, kSame, area), 0.5f) << area;
  }
  EXPECT_GT(clipped, 60);
}

TEST_F(LightChangeTest, FollowsWhatAgreesAndFindsWhatAllHaveInCommon) {
  const image::ColourPatch reference = tissue(160, 1.0, 1);
  image::ColourPatch current = tissue(160, 1.0, 2);
  cv::Mat(current.blue * 0.8).copyTo(current.blue);
  LightChange change(reference, kBins, grid_);
  change.look(tissue(160, 1.0, 3));
  EXPECT_FALSE(change.find()) << "hardly another light";
  change.look(current);
  for (const auto& light : {change.find(), change.follow(std::vector<char>(grid_.count(), 1))}) {
    ASSERT_TRUE(light);
    EXPECT_NEAR((*light)[0].gain * 0.8 * 50 + (*light)[0].offset, 50.0, 2.0);
    EXPECT_NEAR((*light)[2].gain * 130 + (*light)[2].offset, 130.0, 3.0);
  }
  EXPECT_EQ(largestDifference(change.known(), kSame), 0.0f);
  change.learn(*change.find());
  EXPECT_NEAR(change.known()[0].gain, 1.25f, 0.1f);
  for (cv::Mat1b* plane : {&current.blue, &current.green, &current.red}) plane->setTo(120);
  change.look(current);
  EXPECT_FALSE(change.find()) << "a sheet has no pattern";
}

}  // namespace
}  // namespace laparoscope_servo::tracking
