// The comparison with the first view finds known motions and light, knows how sure it is, and refuses what is not
// alike.
#include "features/points/affine_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "seen.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::features {
namespace {

const cv::Size kSize(200, 160);
const Eigen::Vector2d kPlace(100.0, 80.0);

// About the place, which goes to place + shift.
Eigen::Matrix3d affine(const Eigen::Matrix2d& shape, const Eigen::Vector2d& shift) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topLeftCorner<2, 2>() = shape;
  g.topRightCorner<2, 1>() = kPlace + shift - shape * kPlace;
  return g;
}

class AffineFitTest : public testing::Test {
 protected:
  AffineFitTest() {
    picture_ = test::tissue(kSize, 5);
    EXPECT_TRUE(view_.take(seen(test::view(picture_, Eigen::Matrix3d::Identity(), 1.0, 0.0, 1.0, 99)), kPlace, 10));
  }

  AffineFit fit(const cv::Mat& image, const Eigen::Vector2d& off = {0.0, 0.0}) {
    PointPose start;
    start.place = kPlace + off;
    return fitter_.fit(view_, seen(image), start);
  }

  cv::Mat picture_;
  PointView view_;
  AffineFitter fitter_{PointsConfig()};
};

TEST_F(AffineFitTest, FindsShiftsToAFractionOfAPixel) {
  for (const Eigen::Vector2d& shift :
       {Eigen::Vector2d(0.3, -0.4), Eigen::Vector2d(1.5, 0.75), Eigen::Vector2d(-2, 2)}) {
    const AffineFit found = fit(test::view(picture_, affine(Eigen::Matrix2d::Identity(), shift), 1.0, 0.0, 1.0, 3));
    ASSERT_EQ(found.reason, Reason::kNone) << shift.transpose();
    EXPECT_LT((found.pose.place - kPlace - shift).norm(), 0.1) << shift.transpose();
    EXPECT_GT(found.correlation, 0.98);
    EXPECT_GT(found.share, 0.95);
  }
}

TEST_F(AffineFitTest, FindsTurnsGrowthAndShear) {
  Eigen::Matrix2d shear;
  shear << 1.1, 0.08, -0.04, 0.93;
  for (const Eigen::Matrix2d& shape :
       {Eigen::Matrix2d(Eigen::Rotation2Dd(0.15)), Eigen::Matrix2d(1.15 * Eigen::Matrix2d::Identity()),
        Eigen::Matrix2d(0.87 * Eigen::Matrix2d::Identity()), shear}) {
    const AffineFit found = fit(test::view(picture_, affine(shape, {0.5, 0.2}), 1.0, 0.0, 1.0, 3));
    ASSERT_EQ(found.reason, Reason::kNone) << shape;
    EXPECT_LT((found.pose.place - kPlace - Eigen::Vector2d(0.5, 0.2)).norm(), 0.08) << shape;
    EXPECT_LT((found.pose.shape - shape).norm(), 0.03) << found.pose.shape;
  }
}

// An image that shows it twice or half as large is compared on the level that fits.
TEST_F(AffineFitTest, FindsItFarNearerAndFarther) {
  for (const double scale : {0.5, 2.0}) {
    const cv::Mat image =
        test::view(picture_, affine(scale * Eigen::Matrix2d::Identity(), {0.0, 0.0}), 1.0, 0.0, 1.0, 3);
    PointPose start;
    start.place = kPlace + Eigen::Vector2d(0.7, -0.5);
    start.shape = 1.05 * scale * Eigen::Matrix2d::Identity();
    const AffineFit found = fitter_.fit(view_, seen(image), start);
    ASSERT_EQ(found.reason, Reason::kNone) << scale;
    EXPECT_LT((found.pose.place - kPlace).norm(), 0.1 * std::max(1.0, scale)) << scale;
    EXPECT_NEAR(found.pose.scale(), scale, 0.03 * scale);
  }
}

TEST_F(AffineFitTest, FindsGainAndOffsetOfTheLight) {
  for (const double gain : {0.6, 0.8, 1.25}) {
    for (const double offset : {-4.0, 20.0}) {
      const AffineFit found =
          fit(test::view(picture_, affine(Eigen::Matrix2d::Identity(), {0.4, 0.3}), gain, offset, 0.5, 3));
      ASSERT_EQ(found.reason, Reason::kNone) << gain << ' ' << offset;
      EXPECT_LT((found.pose.place - kPlace - Eigen::Vector2d(0.4, 0.3)).norm(), 0.12);
      // gain x image + offset looks like the first view.
      EXPECT_NEAR(found.pose.gain, 1.0 / gain, 0.08 / gain);
      EXPECT_NEAR(found.pose.offset, -offset / gain, 5.0 / gain);
    }
  }
}

// What the covariance promises is what the errors are, over many places and noises; the noise of the first view is a
// part of it.
TEST_F(AffineFitTest, KnowsHowSureItIs) {
  double squares = 0.0;
  int count = 0;
  for (unsigned k = 0; k < 60; ++k) {
    const Eigen::Vector2d place(40.0 + 20.0 * (k % 7), 40.0 + 16.0 * (k % 6));
    PointView view;
    if (!view.take(seen(test::view(picture_, Eigen::Matrix3d::Identity(), 1.0, 0.0, 3.0, 100 + k)), place, 10))
      continue;  // a highlight
    PointPose start;
    start.place = place + Eigen::Vector2d(0.5, -0.5);
    const AffineFit found =
        fitter_.fit(view, seen(test::view(picture_, Eigen::Matrix3d::Identity(), 1.0, 0.0, 3.0, 200 + k)), start);
    if (found.reason != Reason::kNone) continue;
    const Eigen::Vector2d error = found.pose.place - place;
    squares += error.dot(found.covariance.inverse() * error);
    ++count;
    EXPECT_GE(found.expected_error, std::sqrt(found.covariance(0, 0)) - 1e-9);
  }
  ASSERT_GE(count, 50);
  // Two on average, of a covariance that is right.
  EXPECT_GT(squares / count, 0.7);
  EXPECT_LT(squares / count, 3.0);
}

TEST_F(AffineFitTest, RefusesAnotherTexture) {
  int refused = 0;
  for (unsigned seed = 20; seed < 40; ++seed) refused += fit(test::tissue(kSize, seed)).reason != Reason::kNone ? 1 : 0;
  EXPECT_EQ(refused, 20);
}

TEST_F(AffineFitTest, RefusesWhatIsFlat) {
  EXPECT_NE(fit(cv::Mat(kSize, CV_8UC3, cv::Scalar::all(90))).reason, Reason::kNone);
}

// A third that is covered has no say; more than half ends it.
TEST_F(AffineFitTest, BearsACoverOfAThirdAndRefusesMore) {
  for (const double share : {0.3, 0.7}) {
    cv::Mat image = test::view(picture_, affine(Eigen::Matrix2d::Identity(), {0.5, -0.3}), 1.0, 0.0, 1.0, 3);
    image.colRange(0, static_cast<int>(kPlace.x() - 10.0 + 21.0 * share)).setTo(cv::Scalar(190, 190, 195));
    const AffineFit found = fit(image);
    if (share < 0.5) {
      ASSERT_EQ(found.reason, Reason::kNone);
      EXPECT_LT((found.pose.place - kPlace - Eigen::Vector2d(0.5, -0.3)).norm(), 0.15);
      EXPECT_LT(found.share, 0.8);
    } else {
      EXPECT_NE(found.reason, Reason::kNone);
    }
  }
}

TEST_F(AffineFitTest, AHighlightHasNoSay) {
  cv::Mat image = test::view(picture_, affine(Eigen::Matrix2d::Identity(), {0.5, -0.3}), 1.0, 0.0, 1.0, 3);
  cv::circle(image, {104, 84}, 3, cv::Scalar::all(255), -1);
  const AffineFit found = fit(image);
  ASSERT_EQ(found.reason, Reason::kNone);
  EXPECT_LT((found.pose.place - kPlace - Eigen::Vector2d(0.5, -0.3)).norm(), 0.1);
  cv::circle(image, {100, 80}, 9, cv::Scalar::all(255), -1);
  EXPECT_EQ(fit(image).reason, Reason::kCovered);
}

// One edge tells nothing along it.
TEST_F(AffineFitTest, IsUncertainAlongAnEdge) {
  cv::Mat edge(kSize, CV_8UC1, cv::Scalar(80));
  edge.colRange(100, kSize.width).setTo(150);
  cv::GaussianBlur(edge, edge, cv::Size(), 1.0);
  PointView view;
  view.take(seen(test::view(edge, Eigen::Matrix3d::Identity(), 1.0, 0.0, 1.0, 4)), kPlace, 10);
  PointPose start;
  start.place = kPlace;
  const AffineFit found =
      fitter_.fit(view, seen(test::view(edge, Eigen::Matrix3d::Identity(), 1.0, 0.0, 1.0, 5)), start);
  EXPECT_NE(found.reason, Reason::kNone);
}

TEST_F(AffineFitTest, SaysWhenItIsOutsideOrHasNoShape) {
  PointPose start;
  start.place = {-3.0, 80.0};
  EXPECT_EQ(fitter_.fit(view_, seen(picture_), start).reason, Reason::kOutside);
  start.place = {std::nan(""), 80.0};
  EXPECT_EQ(fitter_.fit(view_, seen(picture_), start).reason, Reason::kShape);
  start.place = kPlace;
  start.shape << 1.0, 0.0, 0.0, -1.0;
  EXPECT_EQ(fitter_.fit(view_, seen(picture_), start).reason, Reason::kShape);
}

TEST_F(AffineFitTest, AWindowThatIsNotWholeIsToldToBe) {
  PointView view;
  EXPECT_FALSE(view.take(seen(picture_), {5.0, 80.0}, 10));
  cv::Mat bright = picture_.clone();
  cv::circle(bright, {104, 84}, 2, cv::Scalar::all(255), -1);
  EXPECT_FALSE(view.take(seen(bright), kPlace, 10));
  EXPECT_TRUE(view.take(seen(bright), {50.0, 50.0}, 10));
}

}  // namespace
}  // namespace laparoscope_servo::features
