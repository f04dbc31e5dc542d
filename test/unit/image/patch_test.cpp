#include "laparoscope_servo/image/patch.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::image {
namespace {

TEST(Patch, HasWholeStripsAndAMarginOfZeros) {
  for (int width : {1, 15, 16, 17, 196}) {
    Patch patch;
    patch.resize(width, 5);
    EXPECT_EQ(patch.strips(), (width + 15) / 16);
    patch.view().setTo(7.0f);
    for (int j = -1; j <= 5; ++j) {
      for (int i = -Patch::kStrip; i < (patch.strips() + 1) * Patch::kStrip; ++i) {
        const bool inside = j >= 0 && j < 5 && i >= 0 && i < width;
        ASSERT_EQ(patch.row(j)[i], inside ? 7.0f : 0.0f) << i << ", " << j;
      }
    }
  }
}

TEST(Patch, KeepsItsContentWhenTheSizeStays) {
  Patch patch;
  patch.resize(10, 10);
  patch(3, 4) = 5.0f;
  const float* memory = patch.row(0);
  patch.resize(10, 10);
  EXPECT_EQ(patch(3, 4), 5.0f);
  EXPECT_EQ(patch.row(0), memory);
  patch.resize(11, 10);
  EXPECT_EQ(patch(3, 4), 0.0f);
}

TEST(Patch, TheViewIsThePatch) {
  Patch patch;
  patch.resize(20, 6);
  cv::Mat1f view = patch.view();
  view(5, 19) = 3.0f;
  EXPECT_EQ(patch(5, 19), 3.0f);
  EXPECT_EQ(view.size(), cv::Size(20, 6));
}

TEST(Patch, ExtrapolatesLinearly) {
  Patch patch;
  patch.resize(17, 4);
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 17; ++i) patch(j, i) = static_cast<float>(2 * i - 3 * j);
  }
  patch.extrapolate();
  EXPECT_EQ(patch(2, -1), -2.0f - 6.0f);
  EXPECT_EQ(patch(2, 17), 34.0f - 6.0f);
  EXPECT_EQ(patch(-1, 5), 10.0f + 3.0f);
  EXPECT_EQ(patch(4, 5), 10.0f - 12.0f);
}

}  // namespace
}  // namespace laparoscope_servo::image
