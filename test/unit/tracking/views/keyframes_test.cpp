#include "tracking/views/keyframes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {100, 80, 60, 50};
const cv::Size kSize(320, 240);

// About the ROI's centre, which it moves to `to`.
Eigen::Matrix3d zoomAndTurn(double zoom, double angle, double tilt = 0.0, const Eigen::Vector2d& to = {160.0, 120.0}) {
  Eigen::Matrix3d tilted = Eigen::Matrix3d::Identity();
  tilted(0, 0) = std::cos(tilt);
  return test::zoomAndTurn(kRoi, zoom, angle, tilted, to);
}

class KeyframesTest : public ::testing::Test {
 protected:
  cv::Mat image_ = test::tissue(kSize, 3);
  cv::Mat1f weights_ = cv::Mat1f(50, 60, 1.0f);
  Keyframes keyframes(int capacity) {
    Keyframes result(capacity);
    result.setReference(image_, kRoi, weights_);
    return result;
  }
};

TEST_F(KeyframesTest, DistanceSeesLengthsAndTurnsButNotThePlace) {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  EXPECT_NEAR(keyframeDistance(one, one, kRoi), 0.0, 1e-12);
  EXPECT_NEAR(keyframeDistance(zoomAndTurn(1.0, 0.0, 0.0, {20.0, 30.0}), one, kRoi), 0.0, 1e-9);
  EXPECT_NEAR(keyframeDistance(zoomAndTurn(1.3, 0.0), one, kRoi), 1.0, 1e-9);
  EXPECT_NEAR(keyframeDistance(zoomAndTurn(1.0 / 1.3, 0.0), one, kRoi), 1.0, 1e-9);
  EXPECT_NEAR(keyframeDistance(zoomAndTurn(1.0, -0.6), one, kRoi), 1.0, 1e-9);
  EXPECT_NEAR(keyframeDistance(zoomAndTurn(1.0, 0.0, std::acos(1.0 / 1.3)), one, kRoi), 1.0, 1e-9);
  const Eigen::Matrix3d a = zoomAndTurn(1.4, 0.3, 0.5);
  const Eigen::Matrix3d b = zoomAndTurn(0.8, -1.0, 0.2);
  EXPECT_NEAR(keyframeDistance(a, b, kRoi), keyframeDistance(b, a, kRoi), 1e-9);
  const Eigen::Matrix3d mirrored = Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal();
  EXPECT_TRUE(std::isinf(keyframeDistance(mirrored, one, kRoi)));
}

TEST_F(KeyframesTest, TheReferenceIsFirstAndStays) {
  Keyframes views = keyframes(2);
  for (const double zoom : {1.4, 0.6, 2.0, 3.0, 0.4, 4.5}) {
    const Eigen::Matrix3d g = zoomAndTurn(zoom, 0.0);
    if (views.wants(g)) views.add(image_, g, weights_);
    EXPECT_LE(views.count(), 3);
    EXPECT_EQ(views.at(0).g, Eigen::Matrix3d::Identity());
  }
  EXPECT_EQ(views.count(), 3);
  views.setReference(image_, kRoi, weights_);
  EXPECT_EQ(views.count(), 1);
}

TEST_F(KeyframesTest, WantsOnlyWhatIsNew) {
  Keyframes views = keyframes(4);
  EXPECT_FALSE(views.wants(zoomAndTurn(1.2, 0.3)));
  const Eigen::Matrix3d near = zoomAndTurn(1.5, 0.0);
  ASSERT_TRUE(views.wants(near));
  views.add(image_, near, weights_);
  EXPECT_FALSE(views.wants(near));
  EXPECT_FALSE(views.wants(zoomAndTurn(1.5, 0.2, 0.0, {50.0, 60.0})));
  EXPECT_TRUE(views.wants(zoomAndTurn(1.5, 0.8)));
  EXPECT_FALSE(views.wants(Eigen::Matrix3d::Constant(std::nan(""))));
}

TEST_F(KeyframesTest, WhenFullItSpreadsAndComesToRest) {
  Keyframes views = keyframes(3);
  cv::RNG rng(5);
  int late = 0;
  for (int k = 0; k < 2000; ++k) {
    const Eigen::Matrix3d g =
        zoomAndTurn(std::exp(rng.uniform(-1.0, 1.0)), rng.uniform(-1.5, 1.5), rng.uniform(0.0, 1.0));
    if (!views.wants(g)) continue;
    views.add(image_, g, weights_);
    late += k >= 1000 ? 1 : 0;
  }
  EXPECT_EQ(views.count(), 4);
  EXPECT_LE(late, 2);
}

TEST_F(KeyframesTest, NoneAreWantedWithoutPlaceOrReference) {
  EXPECT_FALSE(keyframes(0).wants(zoomAndTurn(2.0, 0.0)));
  EXPECT_FALSE(Keyframes(4).wants(zoomAndTurn(2.0, 0.0)));
}

TEST_F(KeyframesTest, TheCropIsACopyOfTheRegionWithAMargin) {
  weights_(10, 20) = 0.0f;
  Keyframes views = keyframes(1);
  const Keyframe& reference = views.at(0);
  EXPECT_LT(reference.first.x, 100);
  EXPECT_LT(reference.first.y, 80);
  EXPECT_GT(reference.first.x + reference.crop.cols, 160);
  EXPECT_GT(reference.first.y + reference.crop.rows, 130);
  const cv::Vec3b before = image_.at<cv::Vec3b>(90, 110);
  EXPECT_EQ(reference.crop.at<cv::Vec3b>(90 - reference.first.y, 110 - reference.first.x), before);
  image_.setTo(cv::Scalar(0, 0, 0));
  EXPECT_EQ(reference.crop.at<cv::Vec3b>(90 - reference.first.y, 110 - reference.first.x), before);
  EXPECT_EQ(reference.trusted(10, 20), 0);
  EXPECT_EQ(reference.trusted(10, 21), 255);
  EXPECT_FALSE(reference.described);
}

TEST_F(KeyframesTest, ASmallRegionHasAMarginOfItsOwnSize) {
  const cv::Mat large = test::tissue(cv::Size(640, 480), 4);
  Keyframes views(1);
  views.setReference(large, {100, 80, 200, 200}, cv::Mat1f(200, 200, 1.0f));
  EXPECT_EQ(views.at(0).first, cv::Point(0, 0));
  EXPECT_NEAR(views.at(0).crop.cols, 300 + 0.5 * std::hypot(200, 200), 2.0);
}

TEST_F(KeyframesTest, TheMostRecentViewIsTheLastAndReplaced) {
  Keyframes views = keyframes(2);
  EXPECT_FALSE(views.hasRecent());
  views.addRecent(image_, zoomAndTurn(1.1, 0.0), weights_);
  ASSERT_TRUE(views.hasRecent());
  ASSERT_EQ(views.count(), 2);
  views.at(1).described = true;
  views.at(1).features.points.emplace_back(1.0f, 2.0f);
  const Eigen::Matrix3d turned = zoomAndTurn(1.2, 0.1);
  weights_(3, 4) = 0.0f;
  views.addRecent(image_, turned, weights_);
  ASSERT_EQ(views.count(), 2);
  const Keyframe& recent = views.at(1);
  EXPECT_EQ(recent.g, turned);
  EXPECT_FALSE(recent.described);
  EXPECT_TRUE(recent.features.points.empty());
  EXPECT_EQ(recent.trusted(3, 4), 0);
  EXPECT_EQ(recent.trusted(3, 5), 255);
  EXPECT_EQ(cv::norm(recent.crop, image_(cv::Rect(recent.first, recent.crop.size())), cv::NORM_INF), 0.0);
  // It takes no place, and does not keep others away.
  const Eigen::Matrix3d near = zoomAndTurn(1.5, 0.0);
  views.addRecent(image_, near, weights_);
  ASSERT_TRUE(views.wants(near));
  views.add(image_, near, weights_);
  EXPECT_EQ(views.count(), 3);
  views.setReference(image_, kRoi, weights_);
  EXPECT_FALSE(views.hasRecent());
}

TEST_F(KeyframesTest, NoRecentViewWithoutPlaceOrOutsideTheImage) {
  Keyframes none = keyframes(0);
  none.addRecent(image_, Eigen::Matrix3d::Identity(), weights_);
  EXPECT_FALSE(none.hasRecent());
  Keyframes views = keyframes(2);
  views.addRecent(image_, zoomAndTurn(1.5, 0.0, 0.0, {-4000.0, 0.0}), weights_);
  EXPECT_FALSE(views.hasRecent());
}

TEST_F(KeyframesTest, AViewOutsideTheImageIsNotStored) {
  Keyframes views = keyframes(2);
  views.add(image_, zoomAndTurn(1.5, 0.0, 0.0, {-4000.0, 0.0}), weights_);
  EXPECT_EQ(views.count(), 1);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
