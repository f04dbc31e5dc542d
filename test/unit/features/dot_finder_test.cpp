#include "features/dot_finder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/synthetic_edges.h"

namespace laparoscope_servo::features {
namespace {

const Eigen::Vector2d kPlace(100.3, 80.6);  // px
constexpr double kRadius = 8.0;             // px

struct Drawn {
  double a = kRadius, b = kRadius, angle = 0.0;
  Eigen::Vector2d place = kPlace;
  double inside = 160.0, outside = 80.0, noise = 0.0;
  unsigned seed = 1;
};

cv::Mat picture(const Drawn& drawn, const std::function<void(cv::Mat1f&)>& cover = nullptr) {
  test::EdgeScene scene;
  scene.size = {200, 160};
  scene.dark = drawn.outside;
  scene.bright = drawn.inside;
  scene.noise = drawn.noise;
  scene.seed = drawn.seed;
  return test::draw(scene, test::ellipse(drawn.place, drawn.a, drawn.b, drawn.angle), cover);
}

// Brighter and darker ones alike.
TEST(DotFinder, DiscoversADotByAPointInIt) {
  for (const bool is_bright : {true, false}) {
    Drawn drawn;
    if (!is_bright) std::swap(drawn.inside, drawn.outside);
    DotFinder finder{DotsConfig()};
    for (const Eigen::Vector2d& click : {Eigen::Vector2d(0.0, 0.0), {5.0, 0.0}, {-3.0, -4.0}}) {
      const DotMeasurement dot = finder.discover(picture(drawn), kPlace + click);
      ASSERT_TRUE(dot.found) << is_bright << click.transpose();
      EXPECT_LT((dot.centre - kPlace).norm(), 0.02);
      EXPECT_NEAR(dot.looks.area, M_PI * kRadius * kRadius, 3.0);
      EXPECT_NEAR(dot.looks.level, drawn.inside, 2.0);
      EXPECT_NEAR(dot.looks.background, drawn.outside, 2.0);
      EXPECT_GT(dot.looks.flatness, 0.98);
      EXPECT_LT(dot.roughness, 0.1);
    }
  }
}

TEST(DotFinder, ColourIsItsLuma) {
  const cv::Mat grey = picture({});
  cv::Mat colour;
  cv::merge(std::vector<cv::Mat>{grey, cv::Mat(grey.size(), CV_8UC1, 90), cv::Mat(grey.size(), CV_8UC1, 60)}, colour);
  DotFinder finder{DotsConfig()};
  EXPECT_FALSE(finder.discover(colour, kPlace).found) << "80 levels of blue are 9 of luma";
  cv::merge(std::vector<cv::Mat>{grey, grey, grey}, colour);
  const DotMeasurement dot = finder.discover(colour, kPlace);
  ASSERT_TRUE(dot.found);
  EXPECT_NEAR(dot.looks.level, 160.0, 2.0);
  EXPECT_LT((dot.centre - finder.discover(grey, kPlace).centre).norm(), 1e-3);
}

// The smaller radius over the larger one, whichever way the ellipse lies, until it is too flat for a dot.
TEST(DotFinder, MeasuresHowFlatItIs) {
  DotFinder finder{DotsConfig()};
  for (const double angle : {0.0, 0.4, 1.2}) {
    Drawn drawn;
    drawn.a = 12.0;
    drawn.b = 8.0;
    drawn.angle = angle;
    const DotMeasurement dot = finder.discover(picture(drawn), kPlace);
    ASSERT_TRUE(dot.found) << angle;
    EXPECT_NEAR(dot.looks.flatness, 8.0 / 12.0, 0.03) << angle;
    EXPECT_LT((dot.centre - kPlace).norm(), 0.05);
    drawn.b = 3.5;
    EXPECT_FALSE(finder.discover(picture(drawn), kPlace).found) << "0.29";
  }
}

TEST(DotFinder, IsNoneThatIsTooSmallTooLargeOrTooFaint) {
  DotsConfig config;
  config.max_radius = 15.0;
  config.min_radius = 3.0;
  config.min_contrast = 30.0;
  DotFinder finder(config);
  Drawn drawn;
  for (const auto& [radius, is_found] : {std::pair{2.6, false}, {4.0, true}, {14.0, true}, {16.5, false}}) {
    drawn.a = drawn.b = radius;
    EXPECT_EQ(finder.discover(picture(drawn), kPlace).found, is_found) << radius;
  }
  drawn.a = drawn.b = kRadius;
  for (const double contrast : {25.0, 35.0}) {
    drawn.inside = drawn.outside + contrast;
    EXPECT_EQ(finder.discover(picture(drawn), kPlace).found, contrast > 30.0) << contrast;
  }
}

// A cover over its edge shifts the centre, and shows as roughness.
TEST(DotFinder, ARoughOutlineIsNoDot) {
  const auto bite = [](cv::Mat1f& pixels) { cv::circle(pixels, {108, 80}, 4, cv::Scalar(80.0), cv::FILLED); };
  DotFinder finder{DotsConfig()};
  EXPECT_FALSE(finder.discover(picture({}, bite), kPlace).found);
  DotsConfig patient;
  patient.max_roughness = 10.0;
  const DotMeasurement dot = DotFinder(patient).discover(picture({}, bite), kPlace);
  ASSERT_TRUE(dot.found);
  EXPECT_GT(dot.roughness, 0.3);
  EXPECT_LT(dot.centre.x(), kPlace.x() - 0.2) << "away from the bite";
}

// By its looks, the nearest of those that look like it, and no further away than the range.
TEST(DotFinder, FindsTheOneThatLooksLikeIt) {
  DotsConfig config;
  config.range = 20.0;
  DotFinder finder(config);
  const DotLooks looks = finder.discover(picture({}), kPlace).looks;
  for (const double away : {0.0, 6.0, 15.0, 19.0, 21.0}) {
    const DotMeasurement dot = finder.find(picture({}), kPlace + Eigen::Vector2d(0.6 * away, -0.8 * away), looks);
    EXPECT_EQ(dot.found, away < 20.0) << away;
    if (dot.found) {
      EXPECT_LT((dot.centre - kPlace).norm(), 0.02) << away;
    }
  }
  // A second one of half the area, nearer to where it is expected.
  const cv::Mat two = picture({}, [](cv::Mat1f& pixels) {
    cv::circle(pixels, {125, 80}, 5, cv::Scalar(160.0), cv::FILLED);
  });
  const DotMeasurement dot = finder.find(two, {115.0, 80.0}, looks);
  ASSERT_TRUE(dot.found);
  EXPECT_LT((dot.centre - kPlace).norm(), 0.05);
  DotLooks dark = looks;
  std::swap(dark.level, dark.background);
  EXPECT_FALSE(finder.find(picture({}), kPlace, dark).found) << "a dark dot on bright ground";
}

TEST(DotFinder, FindsItAlsoWhereTheLightHasChanged) {
  DotFinder finder{DotsConfig()};
  const DotLooks looks = finder.discover(picture({}), kPlace).looks;
  for (const double gain : {0.6, 0.75, 1.0, 1.2, 1.5}) {
    Drawn drawn;
    drawn.inside *= gain;
    drawn.outside *= gain;
    const DotMeasurement dot = finder.find(picture(drawn), kPlace + Eigen::Vector2d(4.0, 3.0), looks);
    ASSERT_TRUE(dot.found) << gain;
    EXPECT_LT((dot.centre - kPlace).norm(), 0.02) << gain;
    EXPECT_NEAR(dot.looks.level, drawn.inside, 2.0) << gain;
  }
}

// The covariance is what the centre scatters by.
TEST(DotFinder, TellsHowFarItErrs) {
  DotFinder finder{DotsConfig()};
  Drawn drawn;
  drawn.noise = 6.0;
  double squares = 0.0, expected = 0.0;
  constexpr int kRuns = 60;
  for (int k = 0; k < kRuns; ++k) {
    drawn.seed = static_cast<unsigned>(k + 1);
    const DotMeasurement dot = finder.discover(picture(drawn), kPlace);
    ASSERT_TRUE(dot.found) << k;
    squares += (dot.centre - kPlace).squaredNorm() / kRuns;
    expected += dot.covariance.trace() / kRuns;
    EXPECT_GT(dot.covariance.determinant(), 0.0);
  }
  EXPECT_GT(expected, 0.5 * squares);
  EXPECT_LT(expected, 4.0 * squares);
}

// What goes on outside of the image is not measured, and there is nothing where no image is.
TEST(DotFinder, TheImageEnds) {
  DotFinder finder{DotsConfig()};
  const DotLooks looks = finder.discover(picture({}), kPlace).looks;
  Drawn at_border;
  at_border.place = {5.0, 80.0};
  EXPECT_FALSE(finder.discover(picture(at_border), at_border.place).found);
  EXPECT_FALSE(finder.find(picture(at_border), at_border.place, looks).found);
  const double infinite = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& nowhere :
       {Eigen::Vector2d(-500.0, 80.0), {1e300, 0.0}, {std::nan(""), 5.0}, {5.0, -infinite}}) {
    EXPECT_FALSE(finder.discover(picture({}), nowhere).found) << nowhere.transpose();
    EXPECT_FALSE(finder.find(picture({}), nowhere, looks).found) << nowhere.transpose();
  }
}

}  // namespace
}  // namespace laparoscope_servo::features
