#include "features/shafts/silhouette.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::features {
namespace {

const cv::Scalar kTissue(60, 70, 170), kSteel(140, 140, 140);
constexpr double kThreshold = GreyMap::kZero + 0.25 * GreyMap::kUnit;

// A shaft from the left border to x = 100, between y = 60 and y = 90; a cell of this small picture is a pixel.
class SilhouetteOfAShaft : public testing::Test {
 protected:
  SilhouetteOfAShaft() : image_(150, 200, CV_8UC3, kTissue) {
    paint({0, 60, 100, 30}, kSteel);
    shaft_.edges[0] = edge({0.0, 89.5}, {0.0, 1.0});
    shaft_.edges[1] = edge({0.0, 59.5}, {0.0, -1.0});
    shaft_.entry = {0.0, 74.5};
    shaft_.length = 99.5;
    shaft_.width = 30.0;
  }
  static GreyLine edge(const Eigen::Vector2d& point, const Eigen::Vector2d& outwards) {
    GreyLine line;
    line.point = point;
    line.normal = outwards;
    line.begin = outwards.y() > 0.0 ? -99.5 : 0.0;
    line.end = outwards.y() > 0.0 ? 0.0 : 99.5;
    return line;
  }
  void paint(const cv::Rect& where, const cv::Scalar& colour) { image_(where).setTo(colour); }
  void grow() {
    map_.compute(image_);
    ASSERT_EQ(map_.step(), 1);
    view_.compute(map_.level());
    silhouette_.grow(map_, view_, kThreshold, shaft_);
  }
  cv::Mat1b drawn(double margin = 0.0) {
    cv::Mat1b mask(image_.size(), uchar{0});
    silhouette_.draw(map_, kThreshold, shaft_, margin, mask);
    return mask;
  }

  cv::Mat image_;
  GreyMap map_;
  image::FieldOfView view_;
  Shaft shaft_;
  Silhouette silhouette_;
};

TEST_F(SilhouetteOfAShaft, IsTheShaftAndEndsAtItsTip) {
  grow();
  EXPECT_EQ(silhouette_.count(), 100 * 30);
  EXPECT_GT(silhouette_.fill(), 0.96) << "cells on the edges round outwards";
  EXPECT_NEAR(silhouette_.tip().x(), 99.5, 0.5);
  const cv::Mat1b mask = drawn();
  EXPECT_EQ(mask(75, 50), 255);
  EXPECT_EQ(mask(75, 104), 0);
  EXPECT_EQ(mask(55, 50), 0);
  EXPECT_NEAR(cv::countNonZero(mask), 100 * 30, 200);
}

TEST_F(SilhouetteOfAShaft, JawsThatHangOnBelongToIt) {
  paint({100, 62, 40, 8}, kSteel);
  paint({100, 80, 30, 8}, kSteel);
  grow();
  EXPECT_EQ(silhouette_.count(), 100 * 30 + 40 * 8 + 30 * 8);
  EXPECT_NEAR(silhouette_.tip().x(), 139.5, 0.5) << "of the longer one";
  const cv::Mat1b mask = drawn();
  EXPECT_EQ(mask(66, 130), 255);
  EXPECT_EQ(mask(84, 120), 255);
  EXPECT_EQ(mask(75, 120), 0) << "what is seen between them";
}

TEST_F(SilhouetteOfAShaft, WhatDoesNotHangOnOrLiesTooFarAwayDoesNot) {
  paint({103, 65, 20, 20}, kSteel);  // a gap of three cells
  paint({20, 100, 60, 20}, kSteel);  // beside the shaft
  grow();
  EXPECT_EQ(silhouette_.count(), 100 * 30);
  const cv::Mat1b mask = drawn();
  EXPECT_EQ(mask(75, 113), 0);
  EXPECT_EQ(mask(110, 50), 0);
  paint({100, 70, 100, 8}, kSteel);  // longer than wrist and jaws can be
  grow();
  EXPECT_NEAR(silhouette_.tip().x(), 99.5 + 3.0 * 30.0, 2.0);
}

TEST_F(SilhouetteOfAShaft, AWindowInItIsCoveredAndABayIsNot) {
  paint({100, 60, 40, 30}, kSteel);
  paint({112, 70, 12, 10}, kTissue);  // a window
  paint({130, 70, 10, 10}, kTissue);  // open towards the tip
  grow();
  const cv::Mat1b mask = drawn();
  EXPECT_EQ(mask(75, 118), 255);
  EXPECT_EQ(mask(75, 137), 0);
}

TEST_F(SilhouetteOfAShaft, BeyondTheEdgesItHasToBeGreyer) {
  const cv::Scalar pale(100, 100, 122);  // S0 cos H / mean = 0.2: below the threshold, but not below 0.6 of it
  paint({100, 62, 40, 26}, pale);
  paint({40, 60, 10, 30}, pale);
  grow();
  EXPECT_EQ(silhouette_.count(), 100 * 30) << "the pale ring of the shaft belongs to it, the pale tissue does not";
}

TEST_F(SilhouetteOfAShaft, AnEndInTheShadeLeadsToTheJaws) {
  const cv::Scalar pale(100, 100, 122);
  paint({100, 60, 12, 30}, pale);
  paint({112, 66, 30, 10}, kSteel);
  paint({100, 90, 30, 8}, pale);  // beside it
  grow();
  EXPECT_EQ(silhouette_.count(), 112 * 30 + 30 * 10);
  EXPECT_NEAR(silhouette_.tip().x(), 141.5, 0.5);
  EXPECT_EQ(drawn()(94, 115), 0);
}

TEST_F(SilhouetteOfAShaft, FillIsTheShareOfGreyBetweenTheEdges) {
  paint({0, 60, 50, 30}, kTissue);
  grow();
  EXPECT_NEAR(silhouette_.fill(), 0.5, 0.02);
}

TEST_F(SilhouetteOfAShaft, EachImageIsSeenAnew) {
  grow();
  paint({0, 0, 200, 150}, kTissue);
  grow();
  EXPECT_FALSE(silhouette_.found());
  EXPECT_EQ(silhouette_.count(), 0);
  EXPECT_EQ(silhouette_.fill(), 0.0);
  EXPECT_NEAR(cv::countNonZero(drawn()), 100 * 30, 200) << "only what lies between the edges";
}

TEST_F(SilhouetteOfAShaft, TheMarginGrowsItAllAround) {
  paint({100, 70, 20, 8}, kSteel);
  grow();
  const cv::Mat1b mask = drawn(5.0);
  EXPECT_EQ(mask(56, 50), 255);
  EXPECT_EQ(mask(53, 50), 0);
  EXPECT_EQ(mask(74, 123), 255);
  EXPECT_EQ(mask(74, 127), 0);
}

}  // namespace
}  // namespace laparoscope_servo::features
