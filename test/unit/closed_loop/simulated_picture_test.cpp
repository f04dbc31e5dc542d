#include "closed_loop/simulated_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/servo/view_region.h"

namespace laparoscope_servo::closed_loop {
namespace {

using servo::Task;

constexpr double kD2 = 0.1;  // m

SimulationConfig exact() {
  SimulationConfig config;
  config.corner_noise = config.step_noise = 0.0;
  return config;
}

// Of a plane 0.08 m away, by a camera that has moved as `motion` says (translation, then rotation vector).
Eigen::Matrix3d homography(const Eigen::Vector3d& translation, const Eigen::Vector3d& turn = Eigen::Vector3d::Zero()) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = geometry::so3Exp(turn);
  motion.translation() = translation;
  return geometry::fromPlane(motion, Eigen::Vector3d::UnitZ(), 0.08);
}

class Picture {
 public:
  explicit Picture(const SimulationConfig& configuration)
      : config(configuration), picture(configuration, control, Eigen::Matrix3d::Identity()) {}
  servo::TaskErrorInput expose(Task task, const Eigen::Matrix3d& h, double time = 0.0) {
    return picture.expose(task, time, h, kD2, noise);
  }
  SimulationConfig config;
  servo::ControllerConfig control;
  SimulatedPicture picture;
  Noise noise{1};
};

TEST(SimulatedPicture, WithoutNoiseTheErrorIsThatOfTheTissuesHomography) {
  Picture sees(exact());
  const Eigen::Matrix3d h = homography({0.004, -0.002, 0.01}, {0.02, -0.01, 0.1});
  const servo::TaskErrorInput region = sees.expose(Task::kHoldView, h);
  ASSERT_TRUE(region.valid);
  EXPECT_EQ(region.problem, "");
  const servo::TaskError expected = servo::taskError(h, sees.config.roi, sees.config.camera);
  EXPECT_NEAR(region.error.x, expected.x, 1e-9);
  EXPECT_NEAR(region.error.y, expected.y, 1e-9);
  EXPECT_NEAR(region.error.log_depth, expected.log_depth, 1e-9);
  EXPECT_NEAR(region.error.alpha, expected.alpha, 1e-9);
  const servo::TaskErrorInput view = sees.expose(Task::kStabilise, h);
  ASSERT_TRUE(view.valid);
  const servo::TaskError of_view =
      servo::taskError(h, servo::viewRegion(sees.config.width, sees.config.height), sees.config.camera);
  EXPECT_NEAR(view.error.x, of_view.x, 1e-9);
  EXPECT_GT(std::abs(of_view.alpha - expected.alpha), 1e-6) << "the view is another region";
  EXPECT_NEAR(view.error.alpha, of_view.alpha, 1e-9);
}

// The picture P of the reference and of the present image: H becomes P H P'.
TEST(SimulatedPicture, ATurnedOrMirroredPictureMovesOtherwise) {
  const Eigen::Matrix3d right = homography({-0.004, 0.0, 0.0});  // the tissue goes to the left in the image
  SimulationConfig config = exact();
  EXPECT_NEAR(Picture(config).expose(Task::kHoldView, right).error.x, -0.05, 1e-3);
  config.picture.mirror = "left_right";
  EXPECT_NEAR(Picture(config).expose(Task::kHoldView, right).error.x, 0.05, 1e-3);
  config.picture.mirror = "up_down";
  EXPECT_NEAR(Picture(config).expose(Task::kHoldView, right).error.x, -0.05, 1e-3);
  config.picture.mirror = "none";
  config.picture.roll = 0.5 * M_PI;
  const servo::TaskError turned = Picture(config).expose(Task::kHoldView, right).error;
  EXPECT_NEAR(turned.x, 0.0, 2e-3);
  EXPECT_NEAR(turned.y, -0.05, 2e-3);
  EXPECT_TRUE(Picture(config).picture.seen(Eigen::Matrix3d::Identity()).isIdentity(1e-12))
      << "at rest it does not show";
}

TEST(SimulatedPicture, AFrozenPictureStays) {
  Picture sees(exact());
  const Eigen::Matrix3d then = homography({0.004, 0.0, 0.0}), now = homography({-0.01, 0.01, 0.0});
  EXPECT_FALSE(sees.picture.isFrozen());
  const double x = sees.expose(Task::kHoldView, then).error.x;
  sees.picture.freeze(then);
  EXPECT_TRUE(sees.picture.isFrozen());
  EXPECT_EQ(sees.expose(Task::kHoldView, now).error.x, x);
  EXPECT_EQ(sees.picture.nearestToBorder(now), sees.picture.nearestToBorder(then));
}

TEST(SimulatedPicture, APlaceCountsWhileItIsInTheImage) {
  Picture sees(exact());
  for (const Task task : {Task::kCentreTip, Task::kFollow}) {
    const servo::TaskErrorInput here = sees.expose(task, homography({0.02, 0.0, 0.0}));
    EXPECT_TRUE(here.valid);
    EXPECT_NEAR(here.error.x, 0.25, 2e-3) << "0.02 m aside, 0.08 m away";
    EXPECT_NEAR(here.error.y, 0.0, 2e-3);
    EXPECT_FALSE(sees.expose(task, homography({0.07, 0.0, 0.0})).valid) << "350 px aside of 320";
  }
}

TEST(SimulatedPicture, ARegionHasToBeInTheImageAsAWhole) {
  Picture sees(exact());
  // The region reaches from 270 to 369 px, the image to 639 px: it may go by 270 px, 0.054 m at this distance.
  EXPECT_TRUE(sees.expose(Task::kHoldView, homography({0.0535, 0.0, 0.0})).valid);
  EXPECT_FALSE(sees.expose(Task::kHoldView, homography({0.0545, 0.0, 0.0})).valid);
  EXPECT_NEAR(sees.picture.nearestToBorder(homography({0.0535, 0.0, 0.0})), 2.5, 1e-6);
  EXPECT_LT(sees.picture.nearestToBorder(homography({0.0545, 0.0, 0.0})), 0.0);
  EXPECT_LT(sees.picture.nearestToBorder(homography({0.0, 0.0, -0.09})), 0.0) << "the camera is through the plane";
  // The view is compared with the anchor as long as a quarter of that is seen.
  EXPECT_TRUE(sees.expose(Task::kStabilise, homography({0.0545, 0.0, 0.0})).valid);
  EXPECT_FALSE(sees.expose(Task::kStabilise, homography({0.11, 0.0, 0.0})).valid) << "550 of 640 px aside";
}

TEST(SimulatedPicture, PointsTellTheDisplacementOfTheScopeAlsoWhereSomeAreAstray) {
  SimulationConfig config = exact();
  Picture all(config);
  config.points_astray = 0.3;
  Picture most(config);
  // The scope has turned about the insertion point, 0.1 m behind the camera.
  const Eigen::Vector3d turn(0.0, 0.06, 0.1);
  Eigen::Isometry3d reference_T_camera = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d point(0.0, 0.0, -kD2);
  reference_T_camera.linear() = geometry::so3Exp(turn);
  reference_T_camera.translation() = point - reference_T_camera.linear() * point;
  const Eigen::Matrix3d h =
      geometry::fromPlane(reference_T_camera.inverse(), Eigen::Vector3d::UnitZ(), all.control.features.desired_depth);
  const servo::TaskErrorInput seen = all.expose(Task::kPoints, h);
  ASSERT_TRUE(seen.valid);
  EXPECT_GT(std::hypot(seen.error.x, seen.error.y), 0.05);
  const servo::TaskErrorInput robust = most.expose(Task::kPoints, h);
  ASSERT_TRUE(robust.valid);
  EXPECT_NEAR(robust.error.x, seen.error.x, 1e-3);
  EXPECT_NEAR(robust.error.y, seen.error.y, 1e-3);
  EXPECT_NEAR(robust.error.alpha, seen.error.alpha, 2e-3);
  // POSITION sees the same displacement by the homography.
  const servo::TaskErrorInput position = all.expose(Task::kPosition, h);
  ASSERT_TRUE(position.valid);
  EXPECT_NEAR(position.error.x, seen.error.x, 1e-3);
  EXPECT_NEAR(position.error.alpha, seen.error.alpha, 2e-3);
}

// Half a period after the start, and then again and again: half a sine of cover and noise.
TEST(SimulatedPicture, InstrumentsCrossTheRegion) {
  SimulationConfig config = exact();
  config.corner_noise = 0.5;
  config.crossing.period = 10.0;
  config.crossing.duration = 2.0;
  config.crossing.cover = 0.6;
  config.crossing.noise = 5.0;
  Picture sees(config);
  for (const double from : {0.0, 10.0, 50.0}) {
    for (const double free : {0.1, 4.9, 7.1, 9.9}) {
      const servo::TaskErrorInput seen = sees.expose(Task::kHoldView, Eigen::Matrix3d::Identity(), from + free);
      EXPECT_EQ(seen.visible_fraction, 1.0) << from + free;
      EXPECT_EQ(seen.corner_error, 0.5) << from + free;
    }
    const servo::TaskErrorInput middle = sees.expose(Task::kHoldView, Eigen::Matrix3d::Identity(), from + 6.0);
    EXPECT_NEAR(middle.visible_fraction, 0.4, 1e-9);
    EXPECT_NEAR(middle.corner_error, 2.5, 1e-9);
  }
}

// The noise is that of the corners: as large as it is said to be, and another one in each image.
TEST(SimulatedPicture, CornersHaveTheNoiseThatIsTold) {
  SimulationConfig config = exact();
  config.corner_noise = 0.4;
  Picture sees(config);
  constexpr int kRuns = 2000;
  double squares = 0.0;
  for (int k = 0; k < kRuns; ++k) {
    const servo::TaskErrorInput seen = sees.expose(Task::kFollow, Eigen::Matrix3d::Identity());
    const double u = seen.error.x * config.camera.fx + config.camera.cx - config.roi.centre().x();
    squares += u * u / kRuns;
  }
  EXPECT_NEAR(std::sqrt(squares), 0.4, 0.03);
}

// Where too little of the anchor is left, the view is followed from image to image, and its errors add up.
TEST(SimulatedPicture, ParallelFollowsTheViewBeyondItsAnchor) {
  SimulationConfig config = exact();
  Picture sees(config);
  config.step_noise = 0.2;
  Picture noisy(config);
  const auto differs = [](const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
    return (a / a(2, 2) - b / b(2, 2)).norm();
  };
  double worst = 0.0;
  for (int k = 0; k <= 40; ++k) {
    const Eigen::Matrix3d h = homography({0.003 * k, 0.0, 0.0}, {0.0, 0.002 * k, 0.0});
    const servo::TaskErrorInput seen = sees.expose(Task::kParallel, h);
    ASSERT_TRUE(seen.valid && seen.motion) << k;
    EXPECT_LT(differs(seen.motion->h, h), 1e-6) << k;
    EXPECT_EQ(seen.motion->error, seen.corner_error / config.camera.fx);
    worst = std::max(worst, differs(noisy.expose(Task::kParallel, h).motion->h, h));
    if (k == 10) {
      EXPECT_LT(worst, 1e-6) << "by the anchor there are no steps";
    }
  }
  EXPECT_GT(worst, 1e-4);
}

}  // namespace
}  // namespace laparoscope_servo::closed_loop
