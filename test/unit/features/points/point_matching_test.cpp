#include "laparoscope_servo/features/point_matching.h"

#include <gtest/gtest.h>

#include "laparoscope_servo/geometry/homography.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::features {
namespace {

DescribedPoints drawn(const cv::Mat& image) {
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return drawPoints(grey, cv::Mat1b(grey.size(), static_cast<uchar>(255)), 300);
}

Eigen::Matrix3d turned() {
  const geometry::Rectangle roi{60.0, 50.0, 120.0, 100.0};
  return test::zoomAndTurn(roi, 1.15, 0.3, Eigen::Matrix3d::Identity(), {130.0, 95.0});
}

TEST(PointMatching, MatchesWhatIsTheSame) {
  const cv::Mat scene = test::tissue({240, 200}, 3);
  const DescribedPoints a = drawn(scene), b = drawn(test::view(scene, turned(), 0.8, 10.0, 1.0));
  const auto matches = matchPoints(a, b, 0.85);
  ASSERT_GE(matches.size(), 20u);
  int right = 0;
  for (const auto& [k, l] : matches) {
    const cv::Point2f p = a.points[static_cast<std::size_t>(k)], q = b.points[static_cast<std::size_t>(l)];
    right += (geometry::apply(turned(), Eigen::Vector2d(p.x, p.y)) - Eigen::Vector2d(q.x, q.y)).norm() < 3.0 ? 1 : 0;
  }
  EXPECT_GT(right, 0.7 * static_cast<double>(matches.size()));
}

TEST(PointMatching, OfNothingThereIsNone) {
  const DescribedPoints some = drawn(test::tissue({240, 200}, 3));
  EXPECT_TRUE(matchPoints({}, some, 0.85).empty());
  EXPECT_TRUE(matchPoints(some, {}, 0.85).empty());
}

TEST(PointMatching, FindsTheMotionOnWhichMostAgree) {
  std::vector<cv::Point2f> from, to;
  cv::RNG rng(4);
  for (int k = 0; k < 60; ++k) {
    const Eigen::Vector2d p(rng.uniform(0.0, 240.0), rng.uniform(0.0, 200.0));
    const Eigen::Vector2d q =
        k % 3 == 0 ? Eigen::Vector2d(rng.uniform(0.0, 240.0), rng.uniform(0.0, 200.0)) : geometry::apply(turned(), p);
    from.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
    to.emplace_back(static_cast<float>(q.x()), static_cast<float>(q.y()));
  }
  const auto agreed = agreedMotions(from, to, 2.0, 8);
  ASSERT_EQ(agreed.size(), 2u);  // a similarity and, of so many, a homography
  for (const AgreedMotion& each : agreed) {
    EXPECT_GE(each.inliers, 38);
    const Eigen::Vector2d p(100.0, 80.0);
    EXPECT_LT((geometry::apply(each.motion, p) - geometry::apply(turned(), p)).norm(), 0.1);
  }
}

TEST(PointMatching, FewMatchesAgreeOnNothing) {
  const std::vector<cv::Point2f> few = {{1, 2}, {30, 40}, {50, 10}};
  EXPECT_TRUE(agreedMotions(few, few, 2.0, 8).empty());
  EXPECT_EQ(agreedMotions(few, few, 2.0, 3).size(), 1u);
}

}  // namespace
}  // namespace laparoscope_servo::features
