#include "laparoscope_servo/sim/light.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::sim {
namespace {

const geometry::PinholeCamera kCamera{400.0, 400.0, 320.0, 240.0};
const cv::Size kSize(641, 481);

Plane square(double distance) {
  return {Eigen::Vector3d::UnitZ(), distance};
}

TEST(Lamp, FallsWithTheSquareOfTheDistance) {
  LightConfig config;
  config.reference_distance = 0.08;
  const Lamp lamp(config, kCamera, kSize, 0.0);
  EXPECT_NEAR(lamp.onPlane(square(0.08))(240, 320), 1.0, 1e-6);
  EXPECT_NEAR(lamp.onPlane(square(0.16))(240, 320), 0.25, 1e-6);
  EXPECT_NEAR(lamp.onPlane(square(0.04))(240, 320), 4.0, 1e-5);
  EXPECT_NEAR(lamp.onSurface(320, 240, 0.16), 0.25, 1e-6);
}

TEST(Lamp, IsCosineOverDistanceSquaredTimesTheBeamAtEveryPixel) {
  LightConfig config;
  config.beam_exponent = 1.5;
  const Lamp lamp(config, kCamera, kSize, 0.0);
  const Plane plane{Eigen::Vector3d(0.3, -0.2, 1.0).normalized(), 0.07};
  const cv::Mat1f light = lamp.onPlane(plane);
  for (const cv::Point& pixel : {cv::Point(0, 0), cv::Point(640, 0), cv::Point(100, 480), cv::Point(333, 222)}) {
    const Eigen::Vector3d m((pixel.x - 320.0) / 400.0, (pixel.y - 240.0) / 400.0, 1.0);
    const Eigen::Vector3d point = m * plane.distance / plane.normal.dot(m);
    const double cosine = plane.normal.dot(point) / point.norm();
    const double beam = std::pow(1.0 / m.norm(), config.beam_exponent);
    const double expected = cosine * std::pow(config.reference_distance / point.norm(), 2) * beam;
    EXPECT_NEAR(light(pixel), expected, 1e-5 * expected) << pixel;
    const double facing = std::pow(config.reference_distance / point.norm(), 2) * beam;
    EXPECT_NEAR(lamp.onSurface(pixel.x, pixel.y, point.z()), facing, 1e-5 * facing) << pixel;
  }
}

TEST(Lamp, LeavesDarkWhatItDoesNotMeet) {
  const Lamp lamp(LightConfig(), kCamera, kSize, 0.0);
  EXPECT_EQ(cv::countNonZero(lamp.onPlane(square(-0.05))), 0);
  // Parallel to the axis, to the right of the camera: rays to the left never meet it.
  const cv::Mat1f light = lamp.onPlane({Eigen::Vector3d::UnitX(), 0.05});
  EXPECT_EQ(cv::countNonZero(light.colRange(0, 320)), 0);
  EXPECT_GT(light(240, 600), 0.0);
}

TEST(Lamp, RoundBorderIsBlackOutsideAndUnchangedInside) {
  const Lamp with(LightConfig(), kCamera, kSize, 200.0), without(LightConfig(), kCamera, kSize, 0.0);
  const cv::Mat1f a = with.onPlane(square(0.08)), b = without.onPlane(square(0.08));
  for (int v = 0; v < kSize.height; v += 7) {
    for (int u = 0; u < kSize.width; u += 7) {
      const double radius = std::hypot(u - 320.0, v - 240.0);
      if (radius < 199.0) {
        EXPECT_EQ(a(v, u), b(v, u));
      }
      if (radius > 201.0) {
        EXPECT_EQ(a(v, u), 0.0F);
      }
    }
  }
}

TEST(Exposure, TakesTheFirstImageToItsTargetAndFollowsWithTheTimeConstant) {
  ExposureConfig config;
  config.target = 80.0;
  config.time_constant = 0.5;
  Exposure exposure(config);
  EXPECT_NEAR(exposure.update(40.0, 10.0), 2.0, 1e-12);
  // Light doubles: after one time constant, in whatever steps, 1/e of the logarithm is left.
  double gain = 0.0;
  for (int k = 1; k <= 25; ++k) gain = exposure.update(80.0, 10.0 + 0.02 * k);
  EXPECT_NEAR(std::log(gain), std::log(2.0) * std::exp(-1.0), 1e-9);
  // From before the last image: at once, as the first.
  EXPECT_NEAR(exposure.update(160.0, 3.0), 0.5, 1e-12);
}

TEST(Exposure, StaysInBoundsInTheDarkAndFixedWhenNotAutomatic) {
  ExposureConfig config;
  Exposure exposure(config);
  EXPECT_LE(exposure.update(0.0, 0.0), 100.0);
  config.automatic = false;
  config.gain = 1.7;
  Exposure fixed(config);
  EXPECT_EQ(fixed.update(10.0, 0.0), 1.7);
  EXPECT_EQ(fixed.update(200.0, 5.0), 1.7);
}

}  // namespace
}  // namespace laparoscope_servo::sim
