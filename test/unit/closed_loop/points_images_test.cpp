// POINTS in the closed loop, by rendered images: the scope goes to where a stored picture was taken.
#include <gtest/gtest.h>

#include <cstdio>

#include "support/image_loop.h"

namespace laparoscope_servo {
namespace {

TEST(PointsImages, GoesToWhereAStoredPictureWasTaken) {
  sim::SceneConfig scene;
  scene.tissue.texture_side = 1200;
  test::ImageLoop loop(scene, cv::Mat(), servo::Task::kPoints, {0.08, -0.05, 0.15, 0.008});
  test::PointsEye points(scene.camera.intrinsics, loop.reference(), 40, servo::ControllerConfig());
  const test::Eye eye = [&](const cv::Mat& image, double time) { return points.see(image, time); };
  test::SimulatedCart& cart = loop.cart();
  loop.step(eye);
  ASSERT_GE(points.tracked(), 20) << "of " << points.selected();
  ASSERT_EQ(loop.engage(), "");
  ASSERT_GT(cart.offset(), 40.0);
  const auto isThere = [&] { return cart.offset() < 1.0 && points.tracked() >= 30; };
  for (int k = 0; k < 200 && !isThere(); ++k) {
    loop.step(eye);
    ASSERT_EQ(cart.output.state, servo::ControllerState::kServo) << cart.time() << ": " << cart.output.reason;
  }
  ASSERT_TRUE(isThere()) << cart.offset() << " px, " << points.tracked() << " points";
  std::printf("within 1 px after %.2f s, %d of %d points\n", cart.time(), points.tracked(), points.selected());
  for (int k = 0; k < 50; ++k) {
    loop.step(eye);
    EXPECT_LT(cart.offset(), 2.0) << cart.time();
  }
  // Spin and depth, too.
  const test::ScopeTravel left = cart.travel(Eigen::Isometry3d::Identity());
  EXPECT_LT(left.angle, 0.01);
  EXPECT_LT(left.distance, 0.0015);
}

}  // namespace
}  // namespace laparoscope_servo
