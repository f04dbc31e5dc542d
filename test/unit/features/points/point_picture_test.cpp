#include "features/points/point_picture.h"

#include <gtest/gtest.h>

#include "laparoscope_servo/geometry/homography.h"
#include "seen.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::features {
namespace {

TEST(PointPicture, IsFoundShiftedTurnedAndLarger) {
  for (const cv::Size& size : {cv::Size(320, 240), cv::Size(800, 600)}) {  // the larger one is reduced
    const cv::Mat scene = test::tissue(size, 11);
    const geometry::Rectangle middle{0.25 * size.width, 0.25 * size.height, 0.5 * size.width, 0.5 * size.height};
    const Eigen::Matrix3d g = test::zoomAndTurn(middle, 1.3, 0.4, Eigen::Matrix3d::Identity(),
                                                middle.centre() + Eigen::Vector2d(30.0, -20.0));
    PointPicture picture(seen(scene));
    const auto found = picture.find(seen(test::view(scene, g, 0.85, 5.0, 1.0)));
    ASSERT_FALSE(found.empty()) << size;
    EXPECT_LT((geometry::apply(found.front().motion, middle.centre()) - geometry::apply(g, middle.centre())).norm(),
              3.0 * size.width / 320.0);
  }
}

TEST(PointPicture, IsNotFoundWhereItIsNot) {
  PointPicture picture(seen(test::tissue({320, 240}, 11)));
  for (const AgreedMotion& agreed : picture.find(seen(test::tissue({320, 240}, 12)))) EXPECT_LT(agreed.inliers, 15);
  EXPECT_TRUE(picture.find(seen(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)))).empty());
}

}  // namespace
}  // namespace laparoscope_servo::features
