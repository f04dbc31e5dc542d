#include "laparoscope_servo/image/sketch.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "support/synthetic_sequence.h"

namespace laparoscope_servo::image {
namespace {

class SketchTest : public testing::Test {
 protected:
  static Sketch at(int x, int y, std::uint64_t seed = 1) { return sketchOf(view(x, y, seed)); }
  static cv::Mat view(int x, int y, std::uint64_t seed = 1) {
    static const cv::Mat first = test_support::texture(cv::Size(960, 600), 1),
                         other = test_support::texture(cv::Size(960, 600), 2);
    return (seed == 1 ? first : other)(cv::Rect(x, y, 512, 400)).clone();
  }
};

TEST_F(SketchTest, IsSmallAndTellsOfStructure) {
  const Sketch sketch = at(200, 100);
  EXPECT_EQ(sketch.structure.size(), cv::Size(128, 100));
  EXPECT_TRUE(sketch.tells());
  EXPECT_FALSE(sketch.dark);
  const Sketch bare = sketchOf(cv::Mat(400, 512, CV_8UC3, cv::Scalar::all(100)));
  EXPECT_FALSE(bare.tells());
  EXPECT_FALSE(bare.dark);
  EXPECT_TRUE(sketchOf(cv::Mat(400, 512, CV_8UC1, cv::Scalar(10))).dark);
}

TEST_F(SketchTest, IsLikeWhatIsSeenFromNearby) {
  EXPECT_DOUBLE_EQ(likeness(at(200, 100), at(200, 100)), 1.0);
  // 4 px of the image are one of the sketch: within the first reach, the second, the third
  for (const int x : {204, 224, 300}) EXPECT_GT(likeness(at(200, 100), at(x, 100)), 0.5) << x;
  EXPECT_LT(likeness(at(0, 100), at(440, 100)), 0.15) << "what both show lies beyond the furthest reach";
}

TEST_F(SketchTest, IsNotLikeAnotherPlace) {
  for (int x = 0; x < 440; x += 40) EXPECT_LT(likeness(at(x, 100), at(x, 100, 2)), 0.15) << x;
}

TEST_F(SketchTest, LightDoesNotMatterUntilNothingIsLeft) {
  const cv::Mat image = view(200, 100);
  EXPECT_GT(likeness(sketchOf(image), sketchOf(0.5 * image + cv::Scalar::all(30))), 0.9);
  EXPECT_DOUBLE_EQ(likeness(sketchOf(image), sketchOf(cv::Mat(image.size(), image.type(), cv::Scalar::all(255)))), 0.0);
}

TEST_F(SketchTest, AMixtureIsOfPartsOfBoth) {
  const cv::Mat a = view(200, 100), b = view(200, 100, 2);
  const Sketch before = sketchOf(a), after = sketchOf(b);
  for (const double share : {0.3, 0.5, 0.7})
    EXPECT_GT(mixture(before, sketchOf(share * a + (1.0 - share) * b), after), 0.98) << share;
  EXPECT_DOUBLE_EQ(mixture(before, before, after), 0.0);
  EXPECT_LT(mixture(before, at(100, 100), after), 0.5);
  EXPECT_DOUBLE_EQ(mixture(before, before, before), 0.0) << "there are no two of which it could be";
}

TEST_F(SketchTest, WhatDoesNotTellIsLikeAll) {
  EXPECT_DOUBLE_EQ(likeness(sketchOf(cv::Mat(400, 512, CV_8UC3, cv::Scalar::all(100))), at(200, 100)), 1.0);
}

TEST_F(SketchTest, AnotherShapeIsAnotherPlace) {
  EXPECT_DOUBLE_EQ(likeness(at(200, 100), sketchOf(view(200, 100)(cv::Rect(0, 0, 512, 300)))), 0.0);
}

TEST_F(SketchTest, WhatIsBeyondTheFieldOfViewHasNoBlock) {
  cv::Mat image = view(200, 100), beyond(image.size(), CV_8U, cv::Scalar(255));
  cv::circle(beyond, {256, 200}, 190, 0, cv::FILLED);
  image.setTo(cv::Scalar::all(0), beyond);
  const Sketch sketch = sketchOf(image);
  EXPECT_TRUE(sketch.tells());
  for (const cv::Point& corner : sketch.corners) {
    for (const int x : {0, 15})
      for (const int y : {0, 15}) EXPECT_LE(cv::norm(corner + cv::Point(x, y) - cv::Point(64, 50)), 47.5);
  }
}

}  // namespace
}  // namespace laparoscope_servo::image
