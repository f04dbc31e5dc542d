#include "laparoscope_servo/features/selection_check.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::features {
namespace {

const cv::Size kImage(320, 240);

SelectedFeature curve(FeatureKind kind, const std::vector<Eigen::Vector2d>& points) {
  SelectedFeature selected;
  selected.kind = kind;
  selected.points = points;
  return selected;
}

TEST(SelectionCheck, aCurveMayLeaveTheImageButNotLieBesideIt) {
  EXPECT_NO_THROW(checkInImage(curve(FeatureKind::kLine, {{-50.0, 100.0}, {400.0, 120.0}}), kImage));
  EXPECT_NO_THROW(checkInImage(curve(FeatureKind::kSpline, {{319.0, 239.0}, {400.0, 300.0}, {500.0, 300.0}}), kImage));
  for (const std::vector<Eigen::Vector2d>& beside : {std::vector<Eigen::Vector2d>{{320.0, 10.0}, {400.0, 90.0}},
                                                     {{-90.0, 10.0}, {-1.0, 90.0}},
                                                     {{10.0, 240.0}, {90.0, 300.0}},
                                                     {{10.0, -40.0}, {90.0, -2.0}}}) {
    EXPECT_THROW(checkInImage(curve(FeatureKind::kLine, beside), kImage), std::invalid_argument) << beside[0].x();
  }
}

TEST(SelectionCheck, anEllipseReachesAsFarAsItsLargerRadius) {
  SelectedFeature ellipse = curve(FeatureKind::kEllipse, {});
  ellipse.ellipse = EllipseSelection{{-40.0, 100.0}, 10.0, 50.0, 0.0};
  EXPECT_NO_THROW(checkInImage(ellipse, kImage));
  ellipse.ellipse->centre.x() = -60.0;
  EXPECT_THROW(checkInImage(ellipse, kImage), std::invalid_argument);
}

TEST(SelectionCheck, saysWhereItLiesAndHowLargeTheImageIs) {
  try {
    checkInImage(curve(FeatureKind::kLine, {{9000.0, 60.0}, {9100.0, 50.0}}), kImage);
    FAIL() << "was taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "line between (9000, 50) and (9100, 60), expected a part of it in the image of 320 x 240 px");
  }
}

TEST(SelectionCheck, whatNamesNoPlaceIsAllOfTheImage) {
  EXPECT_NO_THROW(checkInImage(curve(FeatureKind::kMotion, {}), kImage));
}

}  // namespace
}  // namespace laparoscope_servo::features
