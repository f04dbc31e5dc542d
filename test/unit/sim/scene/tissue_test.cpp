#include "laparoscope_servo/sim/tissue.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/sim/texture.h"

namespace laparoscope_servo::sim {
namespace {

const geometry::PinholeCamera kCamera{400.0, 410.0, 319.5, 239.5};
const cv::Size kSize(640, 480);

// The scope turned about an insertion point 0.1 m behind the start pose's camera, and moved deeper.
Eigen::Isometry3d moved(double pan, double tilt, double spin, double deeper) {
  return Eigen::Translation3d(0.0, 0.0, -0.1) * Eigen::AngleAxisd(pan, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(spin, Eigen::Vector3d::UnitZ()) *
         Eigen::Translation3d(0.0, 0.0, 0.1 + deeper);
}

Eigen::Isometry3d tilted() {
  TissueConfig config;
  config.tilt_x = 0.2;
  config.tilt_y = -0.15;
  return placeTissue(config, Eigen::Isometry3d::Identity());
}

// A smooth texture, so that interpolation costs nothing that could hide a shift.
cv::Mat smoothTexture() {
  cv::Mat texture = tissueTexture(1500, 3);
  cv::GaussianBlur(texture, texture, cv::Size(), 6.0);
  return texture;
}

cv::Mat grey(const cv::Mat& image) {
  cv::Mat result;
  cv::cvtColor(image, result, cv::COLOR_BGR2GRAY);
  result.convertTo(result, CV_32F);
  return result;
}

TEST(PlaceTissue, LiesAtTheDistanceAlongTheAxisTurnedByTheTilt) {
  TissueConfig config;
  config.distance = 0.07;
  config.tilt_x = 0.3;
  const Eigen::Isometry3d start = moved(0.3, -0.2, 0.5, 0.01);
  const Eigen::Isometry3d base_T_tissue = placeTissue(config, start);
  EXPECT_TRUE(base_T_tissue.translation().isApprox(start * Eigen::Vector3d(0.0, 0.0, 0.07), 1e-12));
  const Plane plane = planeSeenFrom(start, base_T_tissue);
  EXPECT_NEAR(plane.distance, 0.07 * std::cos(0.3), 1e-12);
  // A positive turn about x tips the far side of the normal up, against y.
  EXPECT_TRUE(plane.normal.isApprox(Eigen::Vector3d(0.0, -std::sin(0.3), std::cos(0.3)), 1e-12));
}

TEST(TrueHomography, TakesPixelsOfATissuePointToPixelsOfTheSamePoint) {
  const Eigen::Isometry3d base_T_tissue = tilted(), reference = moved(0.02, 0.0, 0.1, 0.0);
  const Eigen::Isometry3d current = moved(0.14, 0.1, -0.3, 0.02);
  const Eigen::Matrix3d g = trueHomography(kCamera, base_T_tissue, reference, current);
  EXPECT_NEAR(g.determinant(), 1.0, 1e-9);
  const auto pixel = [&](const Eigen::Isometry3d& base_T_camera, const Eigen::Vector3d& p) {
    return Eigen::Vector2d((kCamera.matrix() * (base_T_camera.inverse() * p)).hnormalized());
  };
  for (const double x : {-0.03, 0.0, 0.02}) {
    for (const double y : {-0.02, 0.015}) {
      const Eigen::Vector3d p = base_T_tissue * Eigen::Vector3d(x, y, 0.0);
      EXPECT_LT((geometry::apply(g, pixel(reference, p)) - pixel(current, p)).norm(), 1e-9);
    }
  }
}

TEST(TrueHomography, IsRefusedForAReferenceBehindTheTissue) {
  EXPECT_THROW(trueHomography(kCamera, tilted(), moved(0.0, 0.0, 0.0, 0.2), moved(0.0, 0.0, 0.0, 0.0)),
               std::invalid_argument);
}

// The image at one pose, warped by the true homography, is the image at the other.
TEST(TissueView, TwoViewsDifferByTheTrueHomography) {
  const Tissue tissue(smoothTexture(), 0.3, tilted());
  const Eigen::Isometry3d reference = moved(0.0, 0.0, 0.0, 0.0);
  const cv::Mat first = grey(tissue.view(kCamera, kSize, 2, reference));
  for (const auto& current : {moved(0.14, 0.1, 0.0, 0.02), moved(-0.1, 0.05, 0.4, -0.02), moved(0.0, 0.0, -0.8, 0.0)}) {
    const cv::Mat second = grey(tissue.view(kCamera, kSize, 2, current));
    const Eigen::Matrix3d g = trueHomography(kCamera, tissue.pose(), reference, current);
    cv::Matx33d m;
    for (int k = 0; k < 9; ++k) m.val[k] = g(k / 3, k % 3);
    cv::Mat back, seen;
    cv::warpPerspective(second, back, m, kSize, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_CONSTANT, -1.0);
    cv::erode(back >= 0.0, seen, cv::Mat(), cv::Point(-1, -1), 2);
    ASSERT_GT(cv::countNonZero(seen), 50000);
    const double rms = cv::norm(first, back, cv::NORM_L2, seen) / std::sqrt(cv::countNonZero(seen));
    EXPECT_LT(rms, 0.7) << "grey levels";
    // The same with the homography a fifth of a pixel off is clearly worse: the comparison above is a sharp one.
    m(0, 2) += 0.2 * m(2, 2), m(1, 2) += 0.2 * m(2, 2);
    cv::warpPerspective(second, back, m, kSize, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_CONSTANT, -1.0);
    EXPECT_GT(cv::norm(first, back, cv::NORM_L2, seen) / std::sqrt(cv::countNonZero(seen)), 1.15 * rms);
  }
}

// Where a chessboard finer than the pixels is seen, its mean is left and no pattern that is not there.
TEST(TissueView, DoesNotAliasFromFarAway) {
  cv::Mat board(1024, 1024, CV_8UC3);
  board.forEach<cv::Vec3b>([](cv::Vec3b& pixel, const int* at) {
    pixel = (at[0] / 2 + at[1] / 2) % 2 == 0 ? cv::Vec3b(0, 0, 0) : cv::Vec3b(200, 200, 200);
  });
  TissueConfig config;
  for (const double distance : {0.5, 0.9, 1.4}) {
    config.distance = distance;
    const Tissue tissue(board, 0.3, placeTissue(config, Eigen::Isometry3d::Identity()));
    for (const int supersampling : {1, 2, 3}) {
      const cv::Mat image = grey(tissue.view(kCamera, kSize, supersampling, Eigen::Isometry3d::Identity()));
      cv::Scalar mean, deviation;
      cv::meanStdDev(image(cv::Rect(290, 210, 60, 60)), mean, deviation);
      EXPECT_NEAR(mean[0], 100.0, 4.0);
      EXPECT_LT(deviation[0], 8.0) << "at " << distance << " m with " << supersampling << " samples";
    }
  }
}

TEST(TissueView, IsBlackBehindTheTissueAndBeyondTheHorizon) {
  const Tissue tissue(smoothTexture(), 0.3, tilted());
  EXPECT_EQ(cv::countNonZero(tissue.view(kCamera, kSize, 2, moved(0.0, 0.0, 0.0, 0.2)).reshape(1)), 0);
  // Looking along the tissue, the upper half of the image goes past it.
  Eigen::Isometry3d along =
      tissue.pose() * Eigen::Translation3d(0.0, 0.0, -0.05) * Eigen::AngleAxisd(CV_PI / 2.0, Eigen::Vector3d::UnitX());
  const cv::Mat image = tissue.view(kCamera, kSize, 2, along);
  EXPECT_EQ(cv::countNonZero(image.rowRange(0, 238).clone().reshape(1)), 0);
  EXPECT_GT(cv::countNonZero(image.rowRange(300, 480).clone().reshape(1)), 0.9 * 180 * 640 * 3);
}

TEST(Tissue, RefusesATextureThatIsNone) {
  const Eigen::Isometry3d pose = tilted();
  EXPECT_THROW(Tissue(cv::Mat(), 0.3, pose), std::invalid_argument);
  EXPECT_THROW(Tissue(cv::Mat::zeros(10, 10, CV_8UC1), 0.3, pose), std::invalid_argument);
  EXPECT_THROW(Tissue(cv::Mat::zeros(10, 10, CV_8UC3), 0.0, pose), std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::sim
