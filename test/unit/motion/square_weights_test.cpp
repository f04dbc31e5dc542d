#include "motion/square_weights.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::motion {
namespace {

class SquareWeights : public testing::Test {
 protected:
  SquareWeights() : image_(120, 160, CV_8UC1, cv::Scalar(100)), squares_(30, 40, static_cast<unsigned char>(1)) {
    pyramid_.build(image_, cv::Rect(0, 0, 160, 120), 4, image::kLuma);
  }
  tracking::EsmLevel levelOf(int l) { return {pyramid_, {0.0, 0.0, 160.0, 120.0}, l}; }

  cv::Mat image_;
  image::RegionPyramid pyramid_;
  Squares squares_;
};

TEST_F(SquareWeights, FinerLevelsRepeatASquare) {
  squares_(10, 20) = 0;
  for (const int l : {0, 1, 2}) {
    tracking::EsmLevel level = levelOf(l);
    setWeights(squares_, 4, level);
    for (int j = 0; j < level.height; ++j) {
      for (int i = 0; i < level.width; ++i) {
        const bool left_out = (j << l) / 4 == 10 && (i << l) / 4 == 20;
        ASSERT_EQ(level.weight(j, i), left_out ? 0.0f : 1.0f) << "level " << l << " at " << i << ", " << j;
      }
    }
  }
}

TEST_F(SquareWeights, CoarserLevelsCountSquares) {
  squares_(10, 20) = 0;  // of the four of the pixel (10, 5)
  squares_(20, 20) = squares_(21, 21) = 0;
  tracking::EsmLevel level = levelOf(3);
  setWeights(squares_, 4, level);
  EXPECT_FLOAT_EQ(level.weight(5, 10), 0.5f);
  EXPECT_FLOAT_EQ(level.weight(10, 10), 0.0f) << "half of it";
  EXPECT_FLOAT_EQ(level.weight(7, 7), 1.0f);
}

}  // namespace
}  // namespace laparoscope_servo::motion
