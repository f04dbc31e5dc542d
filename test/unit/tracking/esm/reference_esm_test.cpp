// The fast alignment against the equations as the papers write them.
#include "tracking/esm/reference_esm.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic_tissue.h"
#include "tracking/esm/esm.h"

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {90, 70, 100, 90};
const cv::Size kSize(280, 240);

class ReferenceEsm : public ::testing::Test {
 protected:
  static image::RegionPyramid pyramidOf(const cv::Mat& image) {
    image::RegionPyramid pyramid;
    pyramid.build(image, cv::Rect(0, 0, image.cols, image.rows), 1, image::kLuma);
    return pyramid;
  }
  Eigen::Matrix3d fast(const cv::Mat& image, int iterations) const {
    EsmConfig config;
    config.levels = 1;
    config.light = Light::kConstant;
    config.robust = false;
    config.max_iterations = iterations;
    config.min_step = 1e-4;
    Esm esm(config);
    esm.setReference(pyramidOf(scene_), kRoi);
    return esm.align(pyramidOf(image), EsmState()).state.g;
  }
  Eigen::Matrix3d plain(const cv::Mat& image, int iterations) const {
    return referenceEsm(pyramidOf(scene_).level(0), kRoi, pyramidOf(image).level(0), Eigen::Matrix3d::Identity(),
                        iterations, 1e-4);
  }

  cv::Mat scene_ = test::tissue(kSize, 11);
};

TEST_F(ReferenceEsm, FindsTheMotion) {
  cv::RNG rng(3);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::Matrix3d truth = test::randomHomography(kRoi, 2.0, rng);
    EXPECT_LT(geometry::cornerDistance(plain(test::view(scene_, truth), 30), truth, kRoi), 0.1) << trial;
  }
}

// Cells of several pixels change the way, hardly the place.
TEST_F(ReferenceEsm, AndTheFastOneComeToTheSamePlace) {
  cv::RNG rng(4);
  for (int trial = 0; trial < 10; ++trial) {
    const cv::Mat image = test::view(scene_, test::randomHomography(kRoi, 2.0, rng), 1.0, 0.0, 2.0, 5 + trial);
    EXPECT_LT(geometry::cornerDistance(plain(image, 50), fast(image, 50), kRoi), 0.02) << trial;
  }
}

TEST_F(ReferenceEsm, AndTheFastOneTakeTheSameFirstStep) {
  cv::RNG rng(6);
  for (int trial = 0; trial < 10; ++trial) {
    const cv::Mat image = test::view(scene_, test::randomHomography(kRoi, 2.0, rng));
    const Eigen::Matrix3d one = plain(image, 1);
    const double length = geometry::cornerDistance(one, Eigen::Matrix3d::Identity(), kRoi);
    ASSERT_GT(length, 0.5);
    EXPECT_LT(geometry::cornerDistance(one, fast(image, 1), kRoi), 0.05 * length) << trial;
  }
}

}  // namespace
}  // namespace laparoscope_servo::tracking
