// Warps through a lens.
#include <gtest/gtest.h>

#include <cmath>

#include "laparoscope_servo/image/colour_patch.h"
#include "laparoscope_servo/image/warp.h"
#include "lens_models.h"

namespace laparoscope_servo::image {
namespace {

class LensWarp : public ::testing::Test {
 protected:
  LensWarp() {
    cv::randu(image_, 0.0f, 255.0f);
    cv::GaussianBlur(image_, image_, cv::Size(), 2.0);
    image_.convertTo(colour_, CV_8U);
    cv::cvtColor(colour_, colour_, cv::COLOR_GRAY2BGR);
    g_ << 1.05, 0.02, 90.3, -0.04, 1.0, 70.7, 1e-4, 2e-5, 1.0;
  }

  cv::Mat1f image_{kSize};
  cv::Mat colour_;
  Eigen::Matrix3d g_;
};

TEST_F(LensWarp, IsThePlainOneWhenAllCoefficientsAreZero) {
  for (const Distortion model : {Distortion::kPlumbBob, Distortion::kRationalPolynomial}) {
    LensParameters p;
    p.distortion = model;
    p.raw = p.rectified = {500.0, 500.0, 320.0, 240.0};
    const Lens lens(p);
    Patch plain, plain_valid, patch, valid;
    for (Patch* each : {&plain, &plain_valid, &patch, &valid}) each->resize(300, 170);
    EXPECT_TRUE(warpBilinear(image_, g_, plain, plain_valid));
    EXPECT_TRUE(warpBilinear(image_, g_, lens, {}, patch, valid));
    for (int j = 0; j < patch.height(); ++j) {
      for (int i = 0; i < patch.width(); ++i) {
        EXPECT_NEAR(patch(j, i), plain(j, i), 0.02);
        EXPECT_EQ(valid(j, i), plain_valid(j, i));
      }
    }
    ColourPatch near, plain_near;
    warpNearest(colour_, g_, cv::Size(300, 170), plain_near);
    warpNearest(colour_, g_, &lens, cv::Size(300, 170), near);
    EXPECT_EQ(cv::countNonZero(near.valid != plain_near.valid), 0);
    EXPECT_LT(cv::countNonZero(near.green != plain_near.green), 300 * 170 / 500)
        << "but for pixels half-way between two";
  }
}

TEST_F(LensWarp, ShowsWhatOpenCvRemaps) {
  for (const LensParameters& p : models()) {
    const Lens lens(p);
    cv::Mat1f u(170, 300), v(170, 300), expected;
    for (int j = 0; j < u.rows; ++j) {
      for (int i = 0; i < u.cols; ++i) {
        const auto raw = lens.toRaw(geometry::apply(g_, Eigen::Vector2d(i, j)));
        ASSERT_TRUE(raw);
        u(j, i) = static_cast<float>(raw->x());
        v(j, i) = static_cast<float>(raw->y());
      }
    }
    cv::remap(image_, expected, u, v, cv::INTER_LINEAR);
    cv::Mat1f patch(u.size()), valid(u.size());
    EXPECT_TRUE(warpBilinear(image_, g_, lens, {}, patch, valid));
    EXPECT_LT(cv::norm(patch, expected, cv::NORM_INF), 1.5) << name(p) << ": OpenCV interpolates in steps of 1/32 px";
    // A crop knows its place.
    const cv::Rect crop(40, 30, 560, 420);
    cv::Mat1f of_crop(u.size()), crop_valid(u.size());
    EXPECT_TRUE(warpBilinear(image_(crop), g_, lens, {crop.tl(), 1.0}, of_crop, crop_valid));
    EXPECT_LT(cv::norm(patch, of_crop, cv::NORM_INF), 0.02) << name(p);
    const cv::Mat1f sharp = rectify(image_(crop), g_, lens, {crop.tl(), 1.0}, u.size());
    EXPECT_LT(cv::norm(patch, sharp, cv::NORM_L2) / std::sqrt(sharp.total()), 1.0) << name(p);
    ColourPatch near;
    warpNearest(colour_, g_, &lens, u.size(), near);
    EXPECT_EQ(cv::countNonZero(near.valid), static_cast<int>(u.total()));
    cv::Mat red;
    cv::Mat planes[3];
    cv::split(colour_, planes);
    cv::remap(planes[2], red, u, v, cv::INTER_NEAREST);
    EXPECT_LT(cv::countNonZero(near.red != red), static_cast<int>(u.total()) / 20) << "OpenCV rounds to 1/32 px first";
  }
}

TEST_F(LensWarp, MarksWhatIsOutsideTheImageOrTheField) {
  LensParameters p;
  p.coefficients = {-0.5};
  p.raw = p.rectified = {400.0, 400.0, 320.0, 240.0};
  const Lens lens(p);
  cv::Mat1f patch(480, 1300), valid(480, 1300);
  Eigen::Matrix3d left = Eigen::Matrix3d::Identity();
  left(0, 2) = -300.0;
  EXPECT_FALSE(warpBilinear(image_, left, lens, {}, patch, valid));
  ColourPatch near;
  warpNearest(colour_, left, &lens, patch.size(), near);
  for (int j = 0; j < patch.rows; j += 5) {
    for (int i = 0; i < patch.cols; i += 5) {
      const auto raw = lens.toRaw(Eigen::Vector2d(i - 300.0, j));
      const bool in = raw && raw->x() > 0.01 && raw->y() > 0.01 && raw->x() < 638.99 && raw->y() < 478.99;
      if (raw && !in && raw->x() > -1.0 && raw->y() > -1.0 && raw->x() < 640.0 && raw->y() < 480.0)
        continue;  // on the border
      EXPECT_EQ(valid(j, i), in ? 1.0f : 0.0f) << i << ", " << j;
      EXPECT_EQ(near.valid(j, i), in ? 255 : 0) << i << ", " << j;
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::image
