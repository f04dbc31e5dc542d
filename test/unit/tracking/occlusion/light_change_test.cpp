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
  LightChange change_{kBins, grid_};
  std::vector<float> plain_;

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
    comparePlainly(reference, current);
    int differ = 0, clipped = 0;
    for (int area = 0; area < grid_.count(); ++area) {
      const float distance = change_.distance(reference, current, area);
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
    const float forth = change_.distance(a, b, area), back = change_.distance(b, a, area);
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
    for (int area = 0; area < grid_.count(); ++area) {
      EXPECT_FALSE(change_.distance(reference, sheet, area) <= 0.5f) << colour << ", area " << area;
    }
  }
}

TEST_F(LightChangeTest, SaysNothingWhereClippingCannotBeTheReason) {
  const auto none = [&](const image::ColourPatch& a, const image::ColourPatch& b) {
    return std::isnan(change_.distance(a, b, 100));
  };
  const image::ColourPatch bright = tissue(240, 1.6, 1);
  EXPECT_FALSE(none(tissue(240, 1.0, 2), bright));
  EXPECT_TRUE(none(tissue(120, 1.0, 1), tissue(120, 1.4, 2)));  // nothing clips
  EXPECT_TRUE(none(tissue(100, 1.0, 1), bright));               // a gain beyond 2
  EXPECT_TRUE(none(tissue(20, 1.0, 1), bright));                // dark
  image::ColourPatch mono = bright;
  mono.has_colour = false;
  EXPECT_TRUE(none(mono, bright));
  EXPECT_TRUE(none(bright, mono));
  image::ColourPatch outside = tissue(240, 1.6, 1);
  outside.valid.setTo(0);
  EXPECT_TRUE(none(bright, outside));
}

}  // namespace
}  // namespace laparoscope_servo::tracking
