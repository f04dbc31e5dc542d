#include "motion/motion_support.h"

#include <gtest/gtest.h>

#include "support/synthetic_motion.h"

namespace laparoscope_servo::motion {
namespace {

using test::movingTissue;
using test::usualMotion;

class MotionSupportTest : public testing::Test {
 protected:
  void judge(const cv::Mat& reference, const cv::Mat& current, const Eigen::Matrix3d& start,
             const MotionConfig& config = MotionConfig()) {
    MotionAligner aligner(config);
    MotionImage before, after;
    before.take(reference, cv::Mat(), config);
    after.take(current, cv::Mat(), config);
    aligner.setReference(before);
    aligner.setUsable(before, after, start, nullptr);
    support_.judge(aligner, after, aligner.align(after, {start}, {}));
  }
  // Share of the map in the box, px of the image, that has this value.
  double shareOf(const cv::Rect& box, unsigned char value) const {
    const cv::Size cell = support_.cellSize();
    int count = 0, all = 0;
    for (int j = box.y / cell.height; j < (box.y + box.height) / cell.height; ++j) {
      for (int i = box.x / cell.width; i < (box.x + box.width) / cell.width; ++i, ++all) {
        if (support_.map()(j, i) == value) ++count;
      }
    }
    return static_cast<double>(count) / all;
  }

  MotionSupport support_;
};

TEST_F(MotionSupportTest, AllFollowsWhereAllMovesAlike) {
  const MotionField field = usualMotion();
  judge(movingTissue(0, field), movingTissue(1, field), homographyOf(field));
  EXPECT_GT(support_.share(), 0.97);
  EXPECT_GT(support_.textured(), 0.9);
  EXPECT_NEAR(support_.sigma(), 1.6, 0.8) << "noise of two grey levels, smoothed";
}

TEST_F(MotionSupportTest, WhatMovesOtherwiseIsForeign) {
  const MotionField field = usualMotion();
  cv::Mat before = movingTissue(0, field), after = movingTissue(1, field);
  const cv::Rect box(32, 32, 128, 128);
  test::cover(before, 0, box, {-3.0, 4.0});
  test::cover(after, 1, box, {-3.0, 4.0});
  judge(before, after, homographyOf(field));
  EXPECT_GT(shareOf(cv::Rect(64, 64, 64, 64), MotionSupport::kForeign), 0.9);
  EXPECT_GT(shareOf(cv::Rect(192, 32, 96, 176), MotionSupport::kFollows), 0.9);
  EXPECT_NEAR(support_.share(), 1.0 - 128.0 * 128.0 / (320.0 * 240.0), 0.12);
}

TEST_F(MotionSupportTest, WhatIsFlatSaysNothing) {
  const MotionField field = usualMotion();
  cv::Mat before = movingTissue(0, field), after = movingTissue(1, field);
  cv::RNG rng(8);
  for (cv::Mat* image : {&before, &after}) {
    cv::Mat plain(240, 160, CV_8UC3);
    rng.fill(plain, cv::RNG::NORMAL, cv::Scalar(90, 100, 150), cv::Scalar(2, 2, 2));
    plain.copyTo((*image)(cv::Rect(0, 0, 160, 240)));
  }
  judge(before, after, homographyOf(field));
  EXPECT_GT(shareOf(cv::Rect(0, 32, 128, 176), MotionSupport::kSilent), 0.9);
  EXPECT_GT(support_.share(), 0.9);
}

// Of an image with a single level what is judged is the finest one, on which each block of light has its own offset.
TEST_F(MotionSupportTest, AllFollowsOnASingleLevelUnderALightThatIsUneven) {
  MotionConfig config;
  config.max_pixels = 80 * 60;
  const MotionField field = usualMotion();
  cv::Mat after = movingTissue(1, field);
  for (int i = 0; i < after.cols; ++i) after.col(i) += cv::Scalar::all(40.0 * i / after.cols - 20.0);
  judge(movingTissue(0, field), after, homographyOf(field), config);
  EXPECT_EQ(support_.level(), 0);
  EXPECT_GT(support_.share(), 0.9);
  EXPECT_LT(support_.sigma(), 4.0) << "grey levels; what is uneven within a block is left";
}

TEST_F(MotionSupportTest, IsCleared) {
  const MotionField field = usualMotion();
  judge(movingTissue(0, field), movingTissue(1, field), homographyOf(field));
  support_.clear();
  EXPECT_EQ(support_.share(), 0.0);
  EXPECT_EQ(shareOf(cv::Rect(0, 0, 320, 240), MotionSupport::kSilent), 1.0);
}

}  // namespace
}  // namespace laparoscope_servo::motion
