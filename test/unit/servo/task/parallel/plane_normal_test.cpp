#include "servo/task/parallel/plane_normal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "unit/servo/task/parallel/plane_scene.h"

namespace laparoscope_servo::servo {
namespace {

constexpr double kImage = 0.04;             // s
constexpr double kRadius = 0.05;            // rad
constexpr double kRate = 2.0 * M_PI / 4.0;  // rad/s: a circle takes 4 s
constexpr double kNoise = 0.3 / 400.0;      // 0.3 px at a focal length of 400 px

using Change = std::function<void(int image, PlaneScene& scene, PlaneView& view)>;

// `images` on the circle; `before` changes the scene, `after` what is told of it.
PlaneEstimate round(PlaneScene& scene, int images, const Change& before = {}, const Change& after = {}) {
  PlaneNormal plane;
  for (int k = 0; k < images; ++k) {
    PlaneView view;
    if (before) before(k, scene, view);
    view.motion = scene.view();
    view.base_R_camera = scene.cameraAt(scene.base_R_shaft).linear();
    view.camera = scene.cameraAt(scene.base_R_shaft).translation();
    if (after) after(k, scene, view);
    plane.add(view);
    const double step = kRadius * kRate * kImage, phase = kRate * kImage * k;
    scene.turn(step * std::cos(phase), step * std::sin(phase));
  }
  return plane.estimate();
}

TEST(PlaneNormal, IsExactWithoutNoise) {
  for (const double azimuth : {0.0, 1.0, 2.5, 4.0}) {
    for (const double slant : {0.0, 0.3, 0.6}) {
      PlaneScene scene;
      scene.normal = PlaneScene::slanted(slant, azimuth);
      const PlaneEstimate found = round(scene, 40);
      ASSERT_TRUE(found.is_known) << slant;
      EXPECT_LT(geometry::angleBetween(found.normal, scene.normal), 1e-6) << slant << ", " << azimuth;
      EXPECT_NEAR(found.distance, scene.distance(), 1e-6);
      EXPECT_NEAR(found.turn_factor, 1.0, 1e-6);
      EXPECT_NEAR(found.agreement, 1.0, 1e-6);
      EXPECT_LT(
          geometry::angleBetween(found.seenFrom(scene.cameraAt(scene.base_R_shaft).linear()), scene.normalInCamera()),
          1e-6);
    }
  }
}

// The optics of 30 degrees, and an anchor image from elsewhere: neither has to be known.
TEST(PlaneNormal, BearsObliqueOpticsAndAnAnchorFromElsewhere) {
  PlaneScene scene;
  scene.camera_R_shaft = scope::obliqueOptics(30.0 * kDegree, 0.7);
  scene.normal = PlaneScene::slanted(0.5, 2.0);
  scene.turn(0.1, -0.07);
  const PlaneEstimate found = round(scene, 40);
  ASSERT_TRUE(found.is_known);
  EXPECT_LT(geometry::angleBetween(found.normal, scene.normal), 1e-6);
  EXPECT_NEAR(found.distance, scene.distance(), 1e-6);
}

// 4 mm at 0.25 Hz, with a part along the normal, while the circle takes 4 s: of the same period.
TEST(PlaneNormal, BreathingTissueDoesNotDisturbIt) {
  PlaneScene scene;
  scene.normal = PlaneScene::slanted(0.5, 1.0);
  const PlaneEstimate found = round(scene, 100, [](int k, PlaneScene& s, PlaneView&) {
    s.tissue = 0.004 * std::sin(2.0 * M_PI * 0.25 * kImage * k) * Eigen::Vector3d(0.3, 0.8, 0.5);
  });
  ASSERT_TRUE(found.is_known);
  EXPECT_LT(geometry::angleBetween(found.normal, scene.normal), 1e-6);
  EXPECT_LT(found.agreement, 0.99) << "the distance is known less well, and that is said";
}

// The arm tells 5 % more of its turns than it makes.
TEST(PlaneNormal, FindsThatTheTurnsAreToldWrong) {
  PlaneScene scene;
  scene.normal = PlaneScene::slanted(0.5, 1.0);
  scene.noise = 0.03 / 400.0;
  const PlaneEstimate found = round(scene, 100, {}, [](int, PlaneScene& s, PlaneView& view) {
    const Eigen::Matrix3d told = geometry::so3Exp(1.05 * geometry::so3Log(s.base_R_shaft));
    view.base_R_camera = s.cameraAt(told).linear();
    view.camera = s.cameraAt(told).translation();
  });
  ASSERT_TRUE(found.is_known);
  EXPECT_NEAR(found.turn_factor, 1.0 / 1.05, 0.005);
  EXPECT_LT(geometry::angleBetween(found.normal, scene.normal), 0.2 * kDegree);
}

// The standard deviation is that of the error in the worst direction: the error of both stays below about 2.5 of it.
TEST(PlaneNormal, TellsHowFarItIsOff) {
  std::vector<double> ratios;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    PlaneScene scene;
    scene.random.seed(seed);
    scene.noise = kNoise;
    scene.normal = PlaneScene::slanted(30.0 * kDegree, seed);
    std::normal_distribution<double> direction(0.0, 0.0009);  // of poses over which was averaged
    const PlaneEstimate found = round(scene, 80, {}, [&](int, PlaneScene& s, PlaneView& view) {
      view.base_R_camera *= geometry::so3Exp({direction(s.random), direction(s.random), 0.0});
    });
    ASSERT_TRUE(found.is_known);
    EXPECT_LT(found.stddev, 0.5 * kDegree);
    ratios.push_back(geometry::angleBetween(found.normal, scene.normal) / found.stddev);
  }
  std::sort(ratios.begin(), ratios.end());
  EXPECT_LT(ratios[20], 1.6);
  EXPECT_GT(ratios[20], 0.5) << "it would be too careful";
  EXPECT_LT(ratios[37], 3.0);
}

TEST(PlaneNormal, IsNotKnownFromWhereTheScopeStands) {
  PlaneScene scene;
  scene.normal = PlaneScene::slanted(0.5, 1.0);
  scene.noise = kNoise;
  PlaneNormal plane;
  for (int k = 0; k < 200; ++k) {
    PlaneView view;
    view.motion = scene.view();
    view.camera = scene.tip().translation();
    plane.add(view);
  }
  EXPECT_TRUE(!plane.estimate().is_known || plane.estimate().stddev > 0.02) << plane.estimate().stddev;
}

TEST(PlaneNormal, AFewViewsThatDoNotFitHaveNoSay) {
  PlaneScene scene;
  scene.normal = PlaneScene::slanted(0.5, 1.0);
  scene.noise = 0.05 / 400.0;
  const PlaneEstimate found = round(scene, 100, {}, [](int k, PlaneScene&, PlaneView& view) {
    if (k % 10 == 5) view.motion.h(2, 0) += 0.05;  // 3 px at the corners
  });
  ASSERT_TRUE(found.is_known);
  EXPECT_LT(geometry::angleBetween(found.normal, scene.normal), 0.2 * kDegree);
}

TEST(PlaneNormal, IgnoresWhatIsNotFinite) {
  PlaneScene scene;
  scene.normal = PlaneScene::slanted(0.5, 1.0);
  const PlaneEstimate found = round(scene, 60, {}, [](int k, PlaneScene&, PlaneView& view) {
    if (k % 3 == 1) view.motion.h(k % 2, 1) = std::numeric_limits<double>::quiet_NaN();
    if (k % 7 == 2) view.base_R_camera(0, 0) = std::numeric_limits<double>::infinity();
    if (k % 11 == 3) view.motion.error = std::numeric_limits<double>::infinity();
  });
  ASSERT_TRUE(found.is_known);
  EXPECT_LT(geometry::angleBetween(found.normal, scene.normal), 1e-6);
}

TEST(PlaneNormal, TakesNoMoreThanItHasRoomForAndBeginsAnew) {
  PlaneScene scene;
  PlaneNormal plane;
  for (std::size_t k = 0; k < PlaneNormal::kMostViews + 10; ++k) {
    PlaneView view;
    view.motion = scene.view();
    view.camera = scene.tip().translation();
    plane.add(view);
  }
  EXPECT_EQ(plane.views(), PlaneNormal::kMostViews);
  plane.restart();
  EXPECT_EQ(plane.views(), 0U);
  EXPECT_FALSE(plane.estimate().is_known);
}

// Turned by the poses to where they have the normal, the camera sees it along its axis.
TEST(PlaneEstimate, TellsTheNormalByThePoses) {
  PlaneEstimate estimate;
  estimate.base_R_first = geometry::so3Exp({0.3, -0.2, 0.5});
  const Eigen::Vector3d turn(0.4, -0.3, 0.0);
  estimate.normal = estimate.base_R_first * (geometry::so3Exp(turn) * Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(PlaneEstimate(estimate).normalOfPoses().isApprox(estimate.normal, 1e-12)) << "poses without a factor";
  estimate.turn_factor = 1.1;
  const Eigen::Matrix3d told = estimate.base_R_first * geometry::so3Exp(turn / 1.1);
  EXPECT_TRUE(estimate.seenFrom(told).isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
  EXPECT_TRUE(estimate.normalOfPoses().isApprox(told.col(2), 1e-12));
}

}  // namespace
}  // namespace laparoscope_servo::servo
