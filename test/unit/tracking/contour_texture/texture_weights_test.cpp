#include "tracking/contour_texture/texture_weights.h"

#include <gtest/gtest.h>

#include "laparoscope_servo/image/pyramid.h"
#include "support/synthetic_edges.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(120, 96);

constexpr double kNoise = 8.0;  // grey levels

// Noise over a texture of this standard deviation.
cv::Mat1b picture(double contrast) {
  cv::Mat1f grain(kSize);
  cv::RNG(3).fill(grain, cv::RNG::NORMAL, 0.0, kNoise);
  cv::Mat1b result;
  cv::Mat(test::texture(kSize, 120.0, contrast, 3.0, 5) + grain).convertTo(result, CV_8UC1);
  return result;
}

TextureWeights weightsOf(const cv::Mat& image, const cv::Mat1b& inside) {
  image::RegionPyramid pyramid;
  pyramid.build(image, cv::Rect(cv::Point(0, 0), kSize), 1, image::kLuma);
  return textureWeights(image, inside, pyramid.level(0), 1);
}

TEST(InsideOf, IsWhatLiesInsideAndAwayFromTheOutline) {
  const std::vector<Eigen::Vector2d> square = {{20, 30}, {80, 30}, {80, 70}, {20, 70}};
  const cv::Mat1b fine = insideOf(square, {10, 20, 90, 60}, 1);
  EXPECT_EQ(cv::boundingRect(fine), cv::Rect(12, 12, 57, 37))
      << "2 px from the outline, which is at 10 to 70, 10 to 50";
  EXPECT_EQ(cv::boundingRect(insideOf(square, {10, 20, 90, 60}, 2)), cv::Rect(14, 14, 53, 33));
}

TEST(TextureWeights, TextureHasAWeightAndNoiseHasNone) {
  const cv::Mat1b all(kSize, 255);
  EXPECT_GT(cv::mean(weightsOf(picture(30.0), all).weights)[0], 0.8);
  EXPECT_LT(cv::mean(weightsOf(picture(0.0), all).weights)[0], 0.1);
}

TEST(TextureWeights, NothingOutsideHasAWeight) {
  cv::Mat1b left = cv::Mat1b::zeros(kSize);
  left(cv::Rect(0, 0, 60, 96)).setTo(255);
  const TextureWeights found = weightsOf(picture(30.0), left);
  EXPECT_EQ(cv::countNonZero(found.weights(cv::Rect(60, 0, 60, 96))), 0);
  EXPECT_GT(cv::mean(found.weights(cv::Rect(0, 0, 60, 96)))[0], 0.8);
}

// A smooth thing before what is brighter: its contour is left to the edges.
TEST(TextureWeights, TheContourIsNoTexture) {
  cv::Mat1b image = picture(0.0);
  image(cv::Rect(60, 0, 60, 96)) += 60;
  cv::Mat1b left = cv::Mat1b::zeros(kSize);
  left(cv::Rect(0, 0, 58, 96)).setTo(255);
  EXPECT_LT(cv::mean(weightsOf(image, left).weights(cv::Rect(40, 0, 18, 96)))[0], 0.1);
}

TEST(TextureWeights, TellsTheNoiseOfGreyAndColour) {
  const cv::Mat1b all(kSize, 255);
  const cv::Mat1b grey = picture(0.0);
  EXPECT_NEAR(weightsOf(grey, all).noise, image::levelNoise(1).deviation * kNoise, 0.5);
  cv::Mat colour;
  cv::merge(std::vector<cv::Mat>{grey, grey, grey}, colour);
  EXPECT_NEAR(weightsOf(colour, all).noise, image::levelNoise(1).deviation * kNoise, 0.5);
  EXPECT_EQ(weightsOf(cv::Mat1b(kSize, 100), all).noise, 1.0) << "the least that a camera has";
}

}  // namespace
}  // namespace laparoscope_servo::tracking
