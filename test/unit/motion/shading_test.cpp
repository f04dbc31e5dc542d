// The light since an image of a while ago, and the motion under it.
#include "motion/shading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "laparoscope_servo/motion/anchored_motion.h"
#include "support/synthetic_motion.h"

namespace laparoscope_servo::motion {
namespace {

using test::kMotionHeight;
using test::kMotionWidth;

// How bright the image is over the reference, as of a lamp that came nearer at the left and went away at the right.
double lamp(double x, double y) {
  return 1.0 - 0.35 * x + 0.1 * y + 0.1 * x * x;
}

cv::Mat shaded(const cv::Mat& image, double share) {
  cv::Mat3b lit = image.clone();
  lit.forEach([&](cv::Vec3b& pixel, const int* at) {
    const double x = 2.0 * at[1] / (kMotionWidth - 1) - 1.0, y = 2.0 * at[0] / (kMotionHeight - 1) - 1.0;
    pixel = cv::Vec3b(cv::Vec3d(pixel) * (1.0 + share * (lamp(x, y) - 1.0)));
  });
  return lit;
}

tracking::EsmLevel levelOf(const cv::Mat& reference, const cv::Mat& image) {
  image::RegionPyramid pyramid;
  const geometry::Rectangle frame = test::motionFrame();
  pyramid.build(image, cv::Rect(0, 0, kMotionWidth, kMotionHeight), 1, image::kLuma, 1);
  const cv::Mat1f there = pyramid.level(0).clone();
  pyramid.build(reference, cv::Rect(0, 0, kMotionWidth, kMotionHeight), 1, image::kLuma, 1);
  tracking::EsmLevel level(pyramid, frame, 0);
  for (int j = 0; j < level.height; ++j) std::copy_n(there[j], level.width, level.planes[0].warped.row(j));
  for (int j = 0; j < level.height; ++j) std::fill_n(level.weight.row(j), level.width, 1.0f);
  level.all_valid = true;
  return level;
}

class ShadingTest : public testing::Test {
 protected:
  // Over the image, of the correction from what it should be.
  double worst(const Shading& shading) const {
    double off = 0.0;
    for (double y = -0.9; y < 1.0; y += 0.3) {
      for (double x = -0.9; x < 1.0; x += 0.3) off = std::max(off, std::abs(shading.at(x, y) * lamp(x, y) - 1.0));
    }
    return off;
  }
  const cv::Mat scene_ = test::tissue({kMotionWidth, kMotionHeight}, 3) * 0.7;
};

TEST_F(ShadingTest, IsFittedToTheLampAndTakesItOut) {
  tracking::EsmLevel level = levelOf(scene_, shaded(scene_, 1.0));
  Shading shading;
  EXPECT_GT(worst(shading), 0.3);
  shading.fit(level);
  EXPECT_LT(worst(shading), 0.06);  // one over a polynomial is none
  shading.correct(level);
  double difference = 0.0, value = 0.0;
  for (int j = 0; j < level.height; ++j) {
    for (int i = 0; i < level.width; ++i) {
      difference += std::abs(static_cast<double>(level.planes[0].warped(j, i) - level.planes[0].value(j, i)));
      value += static_cast<double>(level.planes[0].value(j, i));
    }
  }
  EXPECT_LT(difference, 0.03 * value);
  shading.forget();
  EXPECT_EQ(shading.at(0.5, 0.5), 1.0);
}

TEST_F(ShadingTest, StaysAsItIsWhereTooLittleIsSeen) {
  tracking::EsmLevel level = levelOf(scene_, shaded(scene_, 1.0));
  for (int j = 0; j < level.height; ++j) std::fill_n(level.weight.row(j), level.width, 0.0f);
  Shading shading;
  shading.fit(level);
  EXPECT_EQ(shading.at(-1.0, 0.3), 1.0);
}

// The lamp changes slowly, so that from image to image nothing is seen of it; against the anchor it would pull.
TEST(ShadedMotion, TheMotionSinceTheAnchorIsNotPulledByTheLamp) {
  MotionField field = test::usualMotion();
  field.a *= 0.3;
  AnchoredMotion motion;
  motion.begin(test::movingTissue(0, field, 3, 0.7), 0.0);
  double worst = 0.0;
  for (int k = 1; k <= 20; ++k) {
    const AnchoredResult& result = motion.track(shaded(test::movingTissue(k, field, 3, 0.7), k / 20.0), 0.04 * k);
    ASSERT_EQ(result.state, features::State::kTracking) << k;
    EXPECT_TRUE(result.anchored) << k;
    MotionField all = field;
    all.a *= k;
    worst = std::max(worst, test::motionError(result.g, homographyOf(all)));
  }
  std::printf("worst corner since the anchor: %.3f px\n", worst);
  EXPECT_LT(worst, 0.15);
}

}  // namespace
}  // namespace laparoscope_servo::motion
