// STABILISE in the closed loop, by images: a scope that is driven away from the anchor's view comes back, and neither
// its place nor the measured motion drifts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "laparoscope_servo/motion/anchored_motion.h"
#include "laparoscope_servo/servo/view_region.h"
#include "support/simulated_cart.h"
#include "support/synthetic_motion.h"

namespace laparoscope_servo {
namespace {

using test::SimulatedCart;

const geometry::PinholeCamera kCamera{250.0, 250.0, 159.5, 119.5};
constexpr int kMargin = 300;  // px, of the scene around the anchor image

class Stabilisation {
 public:
  Stabilisation() : cart_(servo::ControllerConfig(), {}, 5) {
    cart_.interference.input = [this](servo::ControllerInput& input, double time) {
      input.view = view_;
      input.view.age = input.view.image_age = time - *view_.image_time;
    };
  }

  // One image, and what happens until the next one.
  void step() {
    const Eigen::Matrix3d true_g = truth();
    const auto& seen = motion_.track(image(true_g), cart_.time());
    if (images_ > 0) by_steps_ = motion_.step().g * by_steps_;
    ++images_;
    ASSERT_EQ(seen.state, features::State::kTracking) << "image " << images_;
    const geometry::Rectangle frame = test::motionFrame();
    const geometry::Rectangle region = servo::viewRegion(frame.width, frame.height);
    measuring_error_ = std::max(measuring_error_, geometry::cornerDistance(seen.g, true_g, region));
    view_.problem.clear();
    view_.valid = true;
    view_.region = 1.0;
    view_.image_time = cart_.time();
    view_.visible_fraction = seen.share > 0.0 ? seen.share : motion_.step().share;
    view_.corner_error = seen.expected_error;
    view_.error = servo::taskError(geometry::normalisedFromPixels(seen.g, kCamera), region, kCamera);
    for (int k = 0; k < SimulatedCart::kImageTicks; ++k) cart_.step();
  }

  // px, of the view's middle from where it was.
  double offset() const {
    const Eigen::Vector2d middle = test::motionFrame().centre();
    return (geometry::apply(truth(), middle) - middle).norm();
  }
  // px, the largest one of all images: at the corners of the view's middle.
  double measuringError() const { return measuring_error_; }
  // px, what the motions from image to image have added up to.
  double integrationError() const {
    const geometry::Rectangle frame = test::motionFrame();
    return geometry::cornerDistance(by_steps_, truth(), servo::viewRegion(frame.width, frame.height));
  }
  SimulatedCart& cart() { return cart_; }

 private:
  Eigen::Matrix3d truth() const {
    return geometry::pixelsFromPlane(cart_.pose().inverse(), Eigen::Vector3d::UnitZ(), SimulatedCart::kDistance,
                                     kCamera);
  }
  cv::Mat image(const Eigen::Matrix3d& g) {
    Eigen::Matrix3d to_scene = Eigen::Matrix3d::Identity();
    to_scene.topRightCorner<2, 1>() << -kMargin, -kMargin;
    cv::Mat image, grain(test::kMotionHeight, test::kMotionWidth, CV_16SC3);
    cv::warpPerspective(scene_, image, test::toMatx(g * to_scene), grain.size(), cv::INTER_CUBIC);
    random_.fill(grain, cv::RNG::NORMAL, 0.0, 2.0);
    cv::add(image, grain, image, cv::noArray(), CV_8U);
    return image;
  }

  cv::Mat scene_ = test::tissue({test::kMotionWidth + 2 * kMargin, test::kMotionHeight + 2 * kMargin}, 12);
  cv::RNG random_{7};
  SimulatedCart cart_;
  motion::AnchoredMotion motion_;
  Eigen::Matrix3d by_steps_ = Eigen::Matrix3d::Identity();
  servo::TaskErrorInput view_;
  double measuring_error_ = 0.0;  // px
  int images_ = 0;
};

TEST(StabiliseImages, ComesBackAndDoesNotDrift) {
  Stabilisation run;
  SimulatedCart& cart = run.cart();
  cart.controller.select(servo::Task::kManual);
  run.step();
  ASSERT_EQ(cart.controller.engage(cart.input()), "");
  for (int k = 0; k < 5; ++k) run.step();
  cart.manual = {0.1, 0.06, 0.0, 0.0};
  for (int k = 0; k < 25; ++k) run.step();
  cart.manual = scope::Velocity();
  for (int k = 0; k < 10; ++k) run.step();
  ASSERT_GT(run.offset(), 40.0);

  cart.controller.select(servo::Task::kStabilise);
  for (int k = 0; k < 210; ++k) {
    run.step();
    ASSERT_EQ(cart.output.state, servo::ControllerState::kServo) << cart.output.reason;
    EXPECT_EQ(cart.velocity()[2], 0.0);
    EXPECT_EQ(cart.velocity()[3], 0.0);
    EXPECT_LT(run.offset(), k > 100 ? 1.0 : 100.0) << k;
  }
  std::printf("after 251 images: %.3f px off; motion since the anchor wrong by %.3f px at most, by steps by %.3f px\n",
              run.offset(), run.measuringError(), run.integrationError());
  EXPECT_LT(run.measuringError(), 0.15);
  EXPECT_LT(run.integrationError(), 0.5);
}

}  // namespace
}  // namespace laparoscope_servo
