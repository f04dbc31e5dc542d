#include "tracking/contour_texture/contour_fit.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "support/contour_scene.h"

namespace laparoscope_servo::tracking {
namespace {

using features::Reason;
using test_support::ContourScene;

class ContourFitTest : public testing::Test {
 protected:
  ContourFitTest() { fit_.setReference(scene_.image(0, 1), contour_); }

  static ContourScene::Look textured() {
    ContourScene::Look look;
    look.texture = 12.0;
    look.background = 8.0;
    return look;
  }
  ContourEstimate align(const cv::Mat& image) { return fit_.align(image, EsmState(), nullptr, 0.3); }
  double error(const ContourEstimate& estimate, int k) const {
    return geometry::cornerDistance(estimate.esm.state.g, scene_.motion(k), fit_.roi());
  }

  const ContourScene scene_{textured()};
  const features::Spline contour_ = features::Spline::throughPoints(ContourScene::selection(0.0)[0].points, true);
  ContourFit fit_{ContourTextureConfig()};
};

TEST_F(ContourFitTest, FindsTheMotionAndHowSureItIs) {
  const ContourEstimate found = align(scene_.image(2, 2));
  EXPECT_EQ(found.reason, Reason::kNone);
  EXPECT_LT(error(found, 2), 0.5);
  EXPECT_GT(found.share, 0.9);
  EXPECT_GT(found.esm.corner_error, 0.01);
  EXPECT_LT(found.esm.corner_error, 0.5);
}

TEST_F(ContourFitTest, ItsBoxIsThatOfTheContour) {
  EXPECT_NEAR(fit_.roi().x, 160.0 - 71.0, 4.0);
  EXPECT_NEAR(fit_.roi().centre().y(), 120.0, 6.0);
  EXPECT_NEAR(fit_.outline().length(), contour_.length(), 1e-9);
}

// Half of either half is covered: what is left of both says where it is, less surely.
TEST_F(ContourFitTest, WhatIsCoveredHasNoSay) {
  const ContourScene::Cover half = [](cv::Mat1f& picture) { picture(cv::Rect(165, 0, 155, 240)).setTo(120.0f); };
  const double before = align(scene_.image(0, 2)).esm.corner_error;
  const ContourEstimate found = align(scene_.image(0, 3, half));
  EXPECT_EQ(found.reason, Reason::kNone);
  EXPECT_LT(error(found, 0), 3.0 * found.esm.corner_error);
  EXPECT_GT(found.esm.corner_error, 1.5 * before);
  EXPECT_LT(found.share, 0.7);
  EXPECT_LT(error(align(scene_.image(0, 4)), 0), 0.5) << "in sight again";
}

TEST_F(ContourFitTest, BelievesNothingWhereItIsNot) {
  const cv::Mat empty(ContourScene::kSize, CV_8UC1, cv::Scalar(100));
  EXPECT_NE(align(empty).reason, Reason::kNone);
  EXPECT_FALSE(fit_.elsewhere(empty, Eigen::Matrix3d::Identity()));
  EsmState away;
  away.g(0, 2) = 400.0;
  EXPECT_EQ(fit_.align(empty, away, nullptr, 0.3).reason, Reason::kOutside);
}

TEST_F(ContourFitTest, TheEdgesAloneSeeItFurtherOff) {
  Eigen::Matrix3d aside = Eigen::Matrix3d::Identity();
  aside(0, 2) = 14.0;
  const std::optional<Eigen::Matrix3d> found = fit_.elsewhere(scene_.image(0, 2), aside);
  ASSERT_TRUE(found);
  EXPECT_LT(geometry::cornerDistance(*found, Eigen::Matrix3d::Identity(), fit_.roi()), 3.0);
}

TEST_F(ContourFitTest, RefusesAContourThatIsTooSmall) {
  const features::Spline small =
      features::Spline::throughPoints({{100, 100}, {110, 100}, {110, 110}, {100, 110}}, true);
  try {
    fit_.setReference(scene_.image(0, 1), small);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("expected at least 16 px"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace laparoscope_servo::tracking
