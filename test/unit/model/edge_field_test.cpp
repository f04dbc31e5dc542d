// Distances to edges of a direction, in a reduced image.
#include "model/edge_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic_edges.h"

namespace laparoscope_servo::model {
namespace {

TEST(EdgeField, aPixelOfTheImageIsFoundInTheField) {
  EdgeField field;
  field.compute(cv::Mat(240, 320, CV_8UC1, cv::Scalar(100)), cv::Rect(40, 20, 160, 120), 2, 8.0);
  EXPECT_EQ(field.size(), cv::Size(40, 30));
  // The middle of the first four by four pixels is the centre of the field's first one.
  EXPECT_TRUE(field.toField({41.5, 21.5}).isMuchSmallerThan(1.0, 1e-12));
  EXPECT_TRUE(field.toField({45.5, 21.5}).isApprox(Eigen::Vector2d(1.0, 0.0)));
}

TEST(EdgeField, theDistanceIsThatToTheEdgeOfTheSitesDirection) {
  test::EdgeScene scene;
  const double theta = 0.3, rho = 180.0;
  const cv::Mat image = test::draw(scene, test::halfPlane(rho, theta));
  EdgeField field;
  field.compute(image, cv::Rect(0, 0, 320, 240), 1, 8.0);
  const Eigen::Vector2d normal(std::cos(theta), std::sin(theta)), across(-normal.y(), normal.x());
  const Eigen::Vector2d on = rho * normal + 20.0 * across;
  for (const double off : {-16.0, -8.0, 8.0, 16.0}) {
    double slope = 0.0;
    const double d = field.distance(field.toField(on + off * normal), normal, slope);
    EXPECT_NEAR(d, std::abs(off) / 2.0, 1.0) << off;
    EXPECT_NEAR(slope, off > 0.0 ? 1.0 : -1.0, 0.25) << off;
    // Either sense of the normal is the same direction; one across it has no edge here.
    EXPECT_NEAR(field.distance(field.toField(on + off * normal), -normal, slope), d, 1e-6);
    EXPECT_NEAR(field.distance(field.toField(on + off * normal), across, slope), EdgeField::kFarthest, 1e-3);
  }
}

TEST(EdgeField, anEdgeWeakerThanTheLeastIsNone) {
  test::EdgeScene scene;
  scene.dark = 100.0;
  scene.bright = 112.0;
  scene.noise = 0.5;
  const cv::Mat image = test::draw(scene, test::halfPlane(160.0, 0.0));
  double slope = 0.0;
  EdgeField field;
  field.compute(image, cv::Rect(0, 0, 320, 240), 1, 3.0);
  EXPECT_LT(field.distance(field.toField({160.0, 120.0}), Eigen::Vector2d::UnitX(), slope), 1.5);
  field.compute(image, cv::Rect(0, 0, 320, 240), 1, 12.0);
  EXPECT_EQ(field.distance(field.toField({160.0, 120.0}), Eigen::Vector2d::UnitX(), slope), EdgeField::kFarthest);
}

// What the area has beyond the image makes no edge along its border.
TEST(EdgeField, theBorderOfTheImageIsNoEdge) {
  EdgeField field;
  field.compute(cv::Mat(240, 320, CV_8UC3, cv::Scalar(50, 100, 150)), cv::Rect(-40, -40, 400, 320), 1, 8.0);
  for (int k = 0; k < EdgeField::kBins; ++k) {
    double least = 0.0;
    cv::minMaxLoc(field.distances(k), &least);
    EXPECT_GE(least, EdgeField::kFarthest) << k;
  }
  double slope = 1.0;
  EXPECT_EQ(field.distance({-1.0, 5.0}, Eigen::Vector2d::UnitX(), slope), EdgeField::kFarthest);
  EXPECT_EQ(slope, 0.0);
}

TEST(EdgeField, aPlaceOrADirectionThatIsNotFiniteIsFarFromEveryEdge) {
  test::EdgeScene scene;
  EdgeField field;
  field.compute(test::draw(scene, test::halfPlane(180.0, 0.3)), cv::Rect(0, 0, 320, 240), 1, 8.0);
  const double nan = std::nan("");
  double slope = 1.0;
  const double far = field.distance({-5.0, 3.0}, {1.0, 0.0}, slope);
  EXPECT_EQ(field.distance({nan, nan}, {nan, nan}, slope), far);
  EXPECT_EQ(slope, 0.0);
  for (const double angle : {0.0, M_PI, -1e-17, 3.0}) {
    const int bin = EdgeField::bin({std::cos(angle), std::sin(angle)});
    EXPECT_GE(bin, 0);
    EXPECT_LT(bin, EdgeField::kBins);
  }
  EXPECT_EQ(EdgeField::bin({-1.0, 0.0}), EdgeField::bin({1.0, 0.0}));
}

}  // namespace
}  // namespace laparoscope_servo::model
