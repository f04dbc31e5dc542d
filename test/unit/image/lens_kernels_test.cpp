// The loops over rows of pixels, against the lens in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "laparoscope_servo/image/lens.h"
#include "lens_models.h"

namespace laparoscope_servo::image {
namespace {

ProjectiveRow rowOf(const Eigen::Matrix3d& rays, double v) {
  const Eigen::Vector3d start = rays.col(1) * v + rays.col(2);
  return {static_cast<float>(start[0]),   static_cast<float>(rays(0, 0)), static_cast<float>(start[1]),
          static_cast<float>(rays(1, 0)), static_cast<float>(start[2]),   static_cast<float>(rays(2, 0))};
}

struct Located {
  Located(const LensLoop& lens, const ProjectiveRow& row, int first, int count)
      : u(static_cast<std::size_t>(count)), v(u.size()) {
    locateRaw(lens, row, first, count, u.data(), v.data());
  }
  std::vector<float> u, v;
};

// In a window at half the size, through a homography.
TEST(LensKernels, FindTheSamePlacesAsTheLens) {
  Eigen::Matrix3d g;
  g << 1.1, 0.05, 60.0, -0.03, 0.95, 40.0, 1e-4, -5e-5, 1.0;
  for (const LensParameters& p : models()) {
    const Lens lens(p);
    const RawWindow window{cv::Point(30, 20), 2.0};
    double worst = 0.0;
    for (int j = 0; j < 300; j += 13) {
      const Located found(lens.loop(window), rowOf(lens.raysFromRectified() * g, j), 0, 400);
      for (std::size_t i = 0; i < found.u.size(); ++i) {
        const auto raw = lens.toRaw(geometry::apply(g, Eigen::Vector2d(static_cast<double>(i), j)));
        ASSERT_TRUE(raw);
        worst = std::max({worst, std::abs(window.scale * static_cast<double>(found.u[i]) + window.origin.x - raw->x()),
                          std::abs(window.scale * static_cast<double>(found.v[i]) + window.origin.y - raw->y())});
      }
    }
    EXPECT_LT(worst, 1e-3) << name(p);
  }
}

// A row may be cut anywhere: the pixels of its pieces are those of the whole.
TEST(LensKernels, ARowIsTheSumOfItsPieces) {
  for (const LensParameters& p : models()) {
    const Lens lens(p);
    const ProjectiveRow row = rowOf(lens.raysFromRectified(), 133.0);
    const Located whole(lens.loop({}), row, 0, 300);
    for (const int first : {0, 1, 7, 16, 299}) {
      const Located piece(lens.loop({}), row, first, 300 - first);
      for (std::size_t i = 0; i < piece.u.size(); ++i) {
        EXPECT_NEAR(piece.u[i], whole.u[i + static_cast<std::size_t>(first)], 1e-4) << name(p) << first;
        EXPECT_NEAR(piece.v[i], whole.v[i + static_cast<std::size_t>(first)], 1e-4) << name(p) << first;
      }
    }
  }
}

// Without distortion the raw pixel is the rectified one, or what the other camera makes of it.
TEST(LensKernels, WithoutDistortionOnlyTheCamerasDiffer) {
  LensParameters p;
  p.rectified = {500.0, 480.0, 320.0, 240.0};
  p.raw = {250.0, 240.0, 160.0, 120.0};
  const Lens lens(p);
  const Located found(lens.loop({}), rowOf(lens.raysFromRectified(), 100.0), 0, 640);
  for (std::size_t i = 0; i < found.u.size(); ++i) {
    EXPECT_NEAR(found.u[i], 0.5 * static_cast<double>(i), 1e-3);
    EXPECT_NEAR(found.v[i], 50.0, 1e-3);
  }
}

// The angle from the axis: the polynomial of the arc tangent is right near the axis, at 45 degrees, where its two
// halves meet, and far out.
TEST(LensKernels, TheAngleIsRightFromTheAxisToTheBorder) {
  LensParameters p;
  p.distortion = Distortion::kEquidistant;
  p.raw = {300.0, 300.0, 0.0, 0.0};
  p.rectified = {100.0, 100.0, 0.0, 0.0};
  const Lens lens(p);
  const Located found(lens.loop({}), rowOf(lens.raysFromRectified(), 0.0), 0, 1000);
  for (std::size_t i = 0; i < found.u.size(); ++i) {
    const double angle = std::atan(static_cast<double>(i) / 100.0);
    EXPECT_NEAR(found.u[i], 300.0 * angle, 1e-3) << i;
    EXPECT_NEAR(found.v[i], 0.0, 1e-3) << i;
  }
}

// What lies behind the camera is seen nowhere, though its ray has the place of one in front.
TEST(LensKernels, NothingIsSeenBehindTheCamera) {
  for (const LensParameters& p : models()) {
    const Lens lens(p);
    ProjectiveRow row = rowOf(lens.raysFromRectified(), 240.0);
    EXPECT_TRUE(std::isfinite(Located(lens.loop({}), row, 320, 1).u[0])) << name(p);
    for (float* const value : {&row.u0, &row.u1, &row.v0, &row.v1, &row.w0, &row.w1}) *value = -*value;
    const Located behind(lens.loop({}), row, 0, 640);
    for (std::size_t i = 0; i < behind.u.size(); ++i) EXPECT_TRUE(std::isnan(behind.u[i]) && std::isnan(behind.v[i]));
  }
}

}  // namespace
}  // namespace laparoscope_servo::image
