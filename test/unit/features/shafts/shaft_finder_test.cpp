#include "features/shafts/shaft_finder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "features/shafts/silhouette.h"
#include "support/synthetic_instrument.h"

namespace laparoscope_servo::features {
namespace {

using test_support::drawShaft;
using test_support::ShaftScene;

struct Finding {
  GreyMap map;
  image::FieldOfView view;
  GreyLevels levels;
  ShaftFinder finder;
  std::vector<Shaft> shafts;

  explicit Finding(const cv::Mat& image) {
    map.compute(image);
    view.compute(map.level());
    levels = greyLevels(map, view);
    shafts = finder.find(map, view, levels);
  }
};

cv::Mat roundBorder(const cv::Mat& image) {
  cv::Mat mask = cv::Mat::zeros(image.size(), CV_8UC1), result = cv::Mat::zeros(image.size(), image.type());
  cv::circle(mask, {image.cols / 2, image.rows / 2}, image.cols / 2 - 20, 255, cv::FILLED);
  image.copyTo(result, mask);
  return result;
}

TEST(GreyMap, StoresHowFarColoursAreFromGrey) {
  cv::Mat image(200, 200, CV_8UC3, cv::Scalar(100, 100, 100));
  image(cv::Rect(0, 0, 100, 100)).setTo(cv::Scalar(50, 50, 200));      // red
  image(cv::Rect(100, 0, 100, 100)).setTo(cv::Scalar(200, 100, 100));  // blue
  image(cv::Rect(0, 100, 100, 100)).setTo(cv::Scalar(4, 4, 4));        // black: no telling
  GreyMap map;
  map.compute(image);
  EXPECT_EQ(map.step(), 1);
  // S0 cos H = 150 at a mean of 100, and -50 ... a blue hue lies 120 degrees from red.
  EXPECT_NEAR(map.colour()(50, 50), GreyMap::kZero + GreyMap::kUnit * 1.5, 3.0);
  EXPECT_NEAR(map.colour()(50, 150), GreyMap::kZero + GreyMap::kUnit * -50.0 / 133.3, 2.0);
  EXPECT_NEAR(map.colour()(150, 150), GreyMap::kZero, 1.5);
  EXPECT_EQ(map.colour()(150, 50), 255);
  EXPECT_EQ(map.level()(150, 150), 100);
}

TEST(GreyMap, CellsOfLargeImagesAreMeans) {
  GreyMap map;
  map.compute(cv::Mat(480, 1280, CV_8UC3, cv::Scalar(10, 20, 60)));
  EXPECT_EQ(map.step(), 6);
  EXPECT_EQ(map.columns(), 213);
  EXPECT_EQ(map.rows(), 80);
  EXPECT_DOUBLE_EQ(map.toPixel(0.0), 2.5);  // the centre of the first six pixels
  EXPECT_DOUBLE_EQ(map.toCell(map.toPixel(17.25)), 17.25);
}

TEST(ShaftFinder, FindsEdgesAxisAndWidth) {
  const ShaftScene scene;
  const Finding found(drawShaft(scene).image);
  ASSERT_EQ(found.shafts.size(), 1u);
  const Shaft& s = found.shafts[0];
  EXPECT_TRUE(s.seen[0] && s.seen[1]);
  const cv::Point2d d = scene.tip - scene.entry;
  const Eigen::Vector2d axis = Eigen::Vector2d(d.x, d.y).normalized();
  EXPECT_GT(s.axis.dot(axis), 0.9995);
  // Each edge to a third of a cell, at its middle.
  const double step = found.map.step();
  for (std::size_t k = 0; k < 2; ++k) {
    const GreyLine& e = s.edges[k];
    const Eigen::Vector2d middle = e.at(0.5 * (e.begin + e.end));
    const Eigen::Vector2d p = Eigen::Vector2d(found.map.toPixel(middle.x()), found.map.toPixel(middle.y())) -
                              Eigen::Vector2d(scene.tip.x, scene.tip.y);
    const double along = -axis.dot(p) / std::hypot(d.x, d.y);  // 0 at the tip, 1 at the entry
    const double half = 0.5 * (scene.tip_width + along * (scene.entry_width - scene.tip_width));
    const double aside = -axis.y() * p.x() + axis.x() * p.y();  // positive on the right
    EXPECT_NEAR(aside, (k == 0 ? half : -half), step / 3.0) << k;
  }
}

TEST(ShaftFinder, AShiftedShaftIsFoundShifted) {
  ShaftScene scene;
  const Finding before(drawShaft(scene).image);
  for (cv::Point2d* p : {&scene.tip, &scene.entry}) *p += cv::Point2d(0.0, 30.0);
  const Finding after(drawShaft(scene).image);
  ASSERT_EQ(before.shafts.size(), 1u);
  ASSERT_EQ(after.shafts.size(), 1u);
  const Eigen::Vector2d across(-before.shafts[0].axis.y(), before.shafts[0].axis.x());
  const Eigen::Vector2d moved = after.shafts[0].entry - before.shafts[0].entry;
  EXPECT_NEAR(across.dot(moved) * before.map.step(), across.dot(Eigen::Vector2d(0.0, 30.0)), 1.5);
}

TEST(ShaftFinder, FindsItInEveryDirectionAndDarkOnesToo) {
  for (int k = 0; k < 12; ++k) {
    ShaftScene scene;
    const double angle = 0.1 + 0.5236 * k;
    scene.tip = {320.0, 240.0};
    scene.entry = scene.tip + 500.0 * cv::Point2d(std::cos(angle), std::sin(angle));
    scene.seed = k + 1;
    if (k % 2 == 1) scene.shaft = cv::Scalar(42, 40, 40);
    const Finding found(drawShaft(scene).image);
    ASSERT_GE(found.shafts.size(), 1u) << k;
    EXPECT_LT(found.shafts[0].axis.dot(Eigen::Vector2d(std::cos(angle), std::sin(angle))), -0.995) << k;
  }
}

TEST(ShaftFinder, TellsHowGreyItIsBetweenTheEdges) {
  ShaftScene scene;
  scene.tissue = {90, 90, 170};
  scene.shaft = {106, 106, 138};  // S0 cos H / mean is 0.27, that of the tissue 0.69
  const Finding grey(drawShaft(scene).image);
  scene.shaft = {130, 130, 182};  // 0.35
  const Finding pale(drawShaft(scene).image);
  ASSERT_EQ(grey.shafts.size(), 1u);
  ASSERT_EQ(pale.shafts.size(), 1u);
  for (const Finding* finding : {&grey, &pale}) {
    const double inside = finding == &grey ? 0.27 : 0.35;
    EXPECT_NEAR(finding->shafts[0].colour, inside * GreyMap::kUnit / (finding->levels.threshold - GreyMap::kZero),
                0.08);
  }
}

TEST(ShaftFinder, TissueAndTheRoundBorderAreNoShafts) {
  for (int seed = 1; seed <= 10; ++seed) {
    ShaftScene scene;
    scene.with_shaft = false;
    scene.highlights = 40;
    scene.seed = seed;
    const cv::Mat image = drawShaft(scene).image;
    EXPECT_TRUE(Finding(image).shafts.empty()) << seed;
    EXPECT_TRUE(Finding(roundBorder(image)).shafts.empty()) << seed;
  }
}

TEST(ShaftFinder, EntersThroughTheRoundBorderToo) {
  const Finding found(roundBorder(drawShaft(ShaftScene()).image));
  ASSERT_EQ(found.shafts.size(), 1u);
  EXPECT_LT(found.map.toPixel(found.shafts[0].entry.x()), 640.0 - 15.0);
}

TEST(ShaftFinder, WhatEndsInsideThePictureOnBothSidesIsNoShaft) {
  ShaftScene scene;
  scene.entry = {520.0, 300.0};
  EXPECT_TRUE(Finding(drawShaft(scene).image).shafts.empty());
}

TEST(Silhouette, CoversTheShaftAndFindsItsTip) {
  const ShaftScene scene;
  const auto picture = drawShaft(scene);
  const Finding found(picture.image);
  ASSERT_EQ(found.shafts.size(), 1u);
  Silhouette silhouette;
  silhouette.grow(found.map, found.view, found.levels.threshold, found.shafts[0]);
  ASSERT_TRUE(silhouette.found());
  EXPECT_GT(silhouette.fill(), 0.95);
  const Eigen::Vector2d tip(found.map.toPixel(silhouette.tip().x()), found.map.toPixel(silhouette.tip().y()));
  const Eigen::Vector2d axis = found.shafts[0].axis;
  EXPECT_NEAR(axis.dot(tip), axis.dot(Eigen::Vector2d(scene.tip.x, scene.tip.y)), 4.0);
  cv::Mat1b mask(picture.image.size(), uchar{0});
  silhouette.draw(found.map, found.levels.threshold, found.shafts[0], 0.0, mask);
  const double both = cv::countNonZero(mask & picture.mask), either = cv::countNonZero(mask | picture.mask);
  EXPECT_GT(both / either, 0.95);
  // Grown by so many px it covers all of it.
  silhouette.draw(found.map, found.levels.threshold, found.shafts[0], 4.0, mask);
  EXPECT_GT(cv::countNonZero(mask & picture.mask), 0.995 * cv::countNonZero(picture.mask));
}

}  // namespace
}  // namespace laparoscope_servo::features
