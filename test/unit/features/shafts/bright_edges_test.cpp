#include "features/shafts/bright_edges.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "features/shafts/shaft_finder.h"

namespace laparoscope_servo::features {
namespace {

const cv::Scalar kTissue(60, 70, 170);  // blue, green, red: a brightness of 99

// A shaft of this grey, 60 px wide, which enters from the right.
struct Scene {
  cv::Mat image;
  GreyMap map;
  std::vector<Shaft> shafts;

  explicit Scene(double grey) : image(480, 640, CV_8UC3, kTissue) {
    const std::vector<cv::Point> outline = {{220, 210}, {660, 260}, {660, 320}, {220, 270}};
    cv::fillConvexPoly(image, outline, cv::Scalar(grey, grey, grey));
    cv::GaussianBlur(image, image, {}, 1.0);
    cv::Mat noise(image.size(), CV_16SC3), wide;
    cv::RNG(3).fill(noise, cv::RNG::NORMAL, 0.0, 1.5);
    image.convertTo(wide, CV_16SC3);
    cv::Mat(wide + noise).convertTo(image, CV_8UC3);
    map.compute(image);
    image::FieldOfView view;
    view.compute(map.level());
    ShaftFinder finder;
    shafts = finder.find(map, view, greyLevels(map, view));
  }
};

TEST(BrightEdges, CountsBothEdgesOfABrighterAndOfADarkerShaft) {
  for (const double grey : {45.0, 160.0}) {
    const Scene scene(grey);
    ASSERT_EQ(scene.shafts.size(), 1u) << grey;
    ASSERT_TRUE(scene.shafts[0].seen[0] && scene.shafts[0].seen[1]);
    EXPECT_EQ(brightEdges(EdgeConfig(), scene.image, scene.map, scene.shafts[0]), 2) << grey;
  }
}

TEST(BrightEdges, AShaftThatIsAsBrightAsTheTissueHasNone) {
  const Scene scene(99.0);
  ASSERT_EQ(scene.shafts.size(), 1u) << "it is found by its colour";
  EXPECT_EQ(brightEdges(EdgeConfig(), scene.image, scene.map, scene.shafts[0]), 0);
}

TEST(BrightEdges, AnEdgeBeyondThePictureOrTooShortDoesNotCount) {
  const Scene scene(160.0);
  ASSERT_EQ(scene.shafts.size(), 1u);
  Shaft shaft = scene.shafts[0];
  shaft.seen[1] = false;
  EXPECT_EQ(brightEdges(EdgeConfig(), scene.image, scene.map, shaft), 1);
  shaft.edges[0].end = shaft.edges[0].begin + 1.0;
  EXPECT_EQ(brightEdges(EdgeConfig(), scene.image, scene.map, shaft), 0);
}

TEST(BrightEdges, AnEdgeThatLiesElsewhereIsNotTakenForIt) {
  const Scene scene(160.0);
  ASSERT_EQ(scene.shafts.size(), 1u);
  Shaft shaft = scene.shafts[0];
  for (std::size_t k = 0; k < 2; ++k) shaft.edges[k].point += 8.0 * shaft.edges[k].normal;  // cells, both outwards
  EXPECT_EQ(brightEdges(EdgeConfig(), scene.image, scene.map, shaft), 0);
  EdgeConfig config;
  config.min_contrast = 100.0;  // grey levels; the step has 61
  EXPECT_EQ(brightEdges(config, scene.image, scene.map, scene.shafts[0]), 0);
}

}  // namespace
}  // namespace laparoscope_servo::features
