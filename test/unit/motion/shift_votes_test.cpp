#include "motion/shift_votes.h"

#include <gtest/gtest.h>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::motion {
namespace {

using image::RegionPyramid;

Eigen::Matrix3d shifted(double x, double y) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() << x, y;
  return g;
}

RegionPyramid pyramidOf(const cv::Mat& image) {
  RegionPyramid pyramid;
  pyramid.build(image, cv::Rect(0, 0, image.cols, image.rows), 3, image::kLuma);
  return pyramid;
}

Eigen::Vector2d votedFor(const cv::Mat& reference, const cv::Mat& current) {
  const RegionPyramid before = pyramidOf(reference), after = pyramidOf(current);
  const tracking::EsmLevel level(before, {0.0, 0.0, 320.0, 240.0}, 2);
  ShiftVotes votes;
  return votes.find(level, after.level(2));
}

TEST(ShiftVotes, FindsAShiftOfAnySign) {
  const cv::Mat scene = test::tissue({320, 240}, 4);
  for (const Eigen::Vector2d& by : {Eigen::Vector2d(8.0, -4.0), Eigen::Vector2d(-12.0, 8.0), Eigen::Vector2d(0.0, 0.0)})
    EXPECT_LT((4.0 * votedFor(scene, test::view(scene, shifted(by.x(), by.y()), 1.0, 0.0, 2.0)) - by).norm(), 1.5);
}

TEST(ShiftVotes, AnOffsetOfTheLightIsNoShift) {
  const cv::Mat scene = test::tissue({320, 240}, 5);
  EXPECT_LT((4.0 * votedFor(scene, test::view(scene, shifted(8.0, 8.0), 1.0, 30.0)) - Eigen::Vector2d(8.0, 8.0)).norm(),
            1.5);
}

TEST(ShiftVotes, TheGreaterPartDecides) {
  const cv::Mat scene = test::tissue({320, 240}, 6);
  cv::Mat seen = test::view(scene, shifted(8.0, 4.0));
  test::view(scene, shifted(-12.0, -8.0))(cv::Rect(0, 0, 130, 240)).copyTo(seen(cv::Rect(0, 0, 130, 240)));
  EXPECT_LT((4.0 * votedFor(scene, seen) - Eigen::Vector2d(8.0, 4.0)).norm(), 1.5);
}

TEST(ShiftVotes, NobodyVotesWithoutTexture) {
  const cv::Mat plain(240, 320, CV_8UC1, cv::Scalar(100));
  EXPECT_EQ(votedFor(plain, plain), Eigen::Vector2d(0.0, 0.0));
}

}  // namespace
}  // namespace laparoscope_servo::motion
