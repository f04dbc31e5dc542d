#include "tracking/search/start_check.h"

#include <gtest/gtest.h>

#include "support/synthetic_lens.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(640, 480);
const geometry::Rectangle kRoi = {220, 140, 180, 150};

class StartCheckTest : public ::testing::Test {
 protected:
  cv::Mat scene_ = test::tissue(kSize, 71);
  StartCheck check_;
  void SetUp() override { check_.setReference(scene_, kRoi, image::kLuma); }
  static Eigen::Matrix3d motion(double zoom, double angle, double x, double y) {
    return test::zoomAndTurn(kRoi, zoom, angle, Eigen::Matrix3d::Identity(), {310.0 + x, 215.0 + y});
  }
};

TEST_F(StartCheckTest, WhereTheRegionIsItCorrelatesAndStays) {
  const CheckedStart at = check_.look(scene_, Eigen::Matrix3d::Identity());
  EXPECT_EQ(at.g, Eigen::Matrix3d::Identity());
  EXPECT_GT(at.correlation, 0.95);
}

TEST_F(StartCheckTest, MovesToWhereTheRegionIsNearby) {
  for (const auto& [zoom, angle] : {std::pair(1.0, 0.0), std::pair(0.7, 0.8), std::pair(1.5, -0.6)}) {
    const Eigen::Matrix3d truth = motion(zoom, angle, 10.0, -6.0);
    const cv::Mat image = test::view(scene_, truth, 0.7, 20.0, 2.0);
    const CheckedStart at = check_.look(image, motion(zoom, angle, 35.0 - 10.0, 12.0 - 6.0));
    EXPECT_LT(geometry::cornerDistance(at.g, truth, kRoi), 6.0) << zoom << ' ' << angle;
    EXPECT_GT(at.correlation, 0.5) << zoom << ' ' << angle;
    EXPECT_NEAR(at.g.determinant(), 1.0, 1e-9);
  }
}

TEST_F(StartCheckTest, TellsHowManyPixelsItTakes) {
  const double usual = check_.pixelsTaken(kSize, Eigen::Matrix3d::Identity());
  EXPECT_NEAR(usual, 1.5 * kRoi.width * (kRoi.height + 0.5 * kRoi.width), 0.05 * usual);
  EXPECT_NEAR(check_.pixelsTaken(kSize, motion(0.5, 0.0, 0.0, 0.0)), 0.25 * usual, 0.03 * usual);
  EXPECT_EQ(check_.pixelsTaken(kSize, motion(10.0, 0.0, 0.0, 0.0)), kSize.area());
  EXPECT_EQ(check_.pixelsTaken(kSize, motion(1.0, 0.0, 5000.0, 0.0)), 0.0);
}

TEST_F(StartCheckTest, HalfOfTheRegionIsStillClearerThanAnotherPlace) {
  cv::Mat half = scene_.clone();
  half(cv::Rect(220, 140, 90, 150)).setTo(cv::Scalar(120, 120, 125));
  const double covered = check_.look(half, Eigen::Matrix3d::Identity()).correlation;
  double elsewhere = 0.0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const cv::Mat other = test::view(test::tissue(kSize, 100 + seed), Eigen::Matrix3d::Identity(), 1.0, 0.0, 2.0, seed);
    elsewhere = std::max(elsewhere, check_.look(other, Eigen::Matrix3d::Identity()).correlation);
  }
  EXPECT_GT(covered, 0.4);
  EXPECT_LT(elsewhere, 0.3);
}

TEST_F(StartCheckTest, TakesGreyImagesAndSmallRegions) {
  cv::Mat grey;
  cv::cvtColor(scene_, grey, cv::COLOR_BGR2GRAY);
  const geometry::Rectangle small = {300, 200, 24, 40};
  check_.setReference(grey, small, image::kLuma);
  Eigen::Matrix3d truth = Eigen::Matrix3d::Identity();
  truth(0, 2) = 5.0;
  const CheckedStart at = check_.look(test::view(grey, truth), Eigen::Matrix3d::Identity());
  EXPECT_LT(geometry::cornerDistance(at.g, truth, small), 1.5);
  EXPECT_GT(at.correlation, 0.8);
}

TEST_F(StartCheckTest, ThroughALens) {
  const auto lens = std::make_shared<const image::Lens>(test::laparoscope(kSize, 500.0));
  const test::LensView view(*lens, kSize);
  StartCheck check(lens);
  check.setReference(view(scene_, Eigen::Matrix3d::Identity()), kRoi, image::kLuma);
  const Eigen::Matrix3d truth = motion(1.0, 0.0, 20.0, 12.0);
  const CheckedStart at = check.look(view(scene_, truth), Eigen::Matrix3d::Identity());
  EXPECT_LT(geometry::cornerDistance(at.g, truth, kRoi), 6.0);
  EXPECT_GT(at.correlation, 0.6);
}

TEST_F(StartCheckTest, OutsideTheImageOrThroughInfinityThereIsNothing) {
  const Eigen::Matrix3d far = motion(1.0, 0.0, 2000.0, 0.0);
  EXPECT_EQ(check_.look(scene_, far).correlation, 0.0);
  EXPECT_EQ(check_.look(scene_, far).g, far);
  Eigen::Matrix3d through = Eigen::Matrix3d::Identity();
  through(2, 0) = -1.0 / 300.0;
  EXPECT_EQ(check_.look(scene_, through).correlation, 0.0);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
