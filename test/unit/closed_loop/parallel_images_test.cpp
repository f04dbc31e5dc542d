// PARALLEL in the closed loop, by rendered images: the lamp goes along with the scope, and slanted tissue is several
// times as bright where it is near as where it is far.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "support/image_loop.h"

namespace laparoscope_servo {
namespace {

constexpr double kDegree = M_PI / 180.0;

TEST(ParallelImages, FacesShadedTissueFromThirtyDegrees) {
  for (const int seed : {1, 2}) {
    sim::SceneConfig scene;
    scene.camera.width = 320;
    scene.camera.height = 240;
    scene.camera.intrinsics = {200.0, 200.0, 159.5, 119.5};
    scene.tissue.seed = seed;
    scene.tissue.texture_side = 1200;
    scene.tissue.tilt_x = seed == 1 ? 0.4 : -0.4;
    scene.tissue.tilt_y = 0.3475;
    test::ImageLoop loop(scene, cv::Mat(), servo::Task::kParallel, {});
    ASSERT_NEAR(loop.slant(), 30.0 * kDegree, 0.1 * kDegree);
    test::ViewEye view(scene.camera.intrinsics, {scene.camera.width, scene.camera.height});
    const test::Eye eye = [&](const cv::Mat& image, double time) { return view.see(image, time); };
    test::SimulatedCart& cart = loop.cart();
    loop.step(eye);
    ASSERT_EQ(loop.engage(), "");
    loop.step(eye);
    for (int k = 0; k < 200 && cart.output.state != servo::ControllerState::kIdle; ++k) loop.step(eye);
    ASSERT_EQ(cart.output.state, servo::ControllerState::kIdle) << cart.output.reason;
    const servo::ParallelFigures figures = cart.controller.figures().parallel;
    ASSERT_TRUE(figures.is_known) << cart.output.reason;
    const double wrong = geometry::angleBetween(figures.normal, loop.normal());
    EXPECT_LT(wrong, 0.7 * kDegree);  // images of 320 x 240 px
    ASSERT_EQ(loop.engage(), "");
    for (int k = 0; k < 300; ++k) loop.step(eye);
    std::printf("seed %d: the normal is off by %.2f degrees, the axis by %.2f at the end\n", seed, wrong / kDegree,
                loop.slant() / kDegree);
    EXPECT_EQ(cart.output.state, servo::ControllerState::kServo) << cart.output.reason;
    EXPECT_LT(loop.slant(), 1.0 * kDegree);
  }
}

}  // namespace
}  // namespace laparoscope_servo
