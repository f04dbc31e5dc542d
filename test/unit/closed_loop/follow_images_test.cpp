// FOLLOW in the closed loop, by images: an object that moves over the tissue is kept in the middle while another one
// crosses it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "support/image_loop.h"
#include "support/synthetic_motion.h"

namespace laparoscope_servo {
namespace {

using test::SimulatedCart;

const geometry::PinholeCamera kCamera{250.0, 250.0, 159.5, 119.5};
constexpr int kMargin = 300;        // px, of the scene around the reference image
const cv::Size kObject(88, 70);     // px: 8 % of the image
const cv::Size kCrossing(24, 150);  // px
constexpr double kSpeed = 20.0;     // px/s
constexpr double kWay = 70.0;       // px, to and fro

Eigen::Matrix3d shift(const Eigen::Vector2d& by) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() = by;
  return g;
}

class Following {
 public:
  Following() : cart_(servo::ControllerConfig(), {}, 5) {
    cart_.interference.input = [this](servo::ControllerInput& input, double time) {
      input.object = object_;
      input.object.age = input.object.image_age = time - object_.image_time.value_or(time);
    };
  }

  // One image, and what happens until the next one.
  void step() {
    see(image());
    for (int k = 0; k < SimulatedCart::kImageTicks; ++k) cart_.step();
  }

  // px, of the object's middle from the principal point.
  double offset() const {
    return (geometry::apply(truth(), middle()) - kCamera.matrix().topRightCorner<2, 1>()).norm();
  }
  // px, of where the object is seen from where it is.
  double measuringError() const { return (eye_->place() - geometry::apply(truth(), middle())).norm(); }
  double share() const { return eye_->motion().share; }
  SimulatedCart& cart() { return cart_; }

 private:
  // In the reference image.
  Eigen::Vector2d middle() const {
    const double way = std::fmod(kSpeed * cart_.time(), 2.0 * kWay);
    return {130.0 + (way < kWay ? way : 2.0 * kWay - way), 95.0};
  }
  Eigen::Matrix3d truth() const {
    return geometry::pixelsFromPlane(cart_.pose().inverse(), Eigen::Vector3d::UnitZ(), SimulatedCart::kDistance,
                                     kCamera);
  }
  static geometry::Rectangle regionAt(const Eigen::Vector2d& middle) {
    return {std::round(middle.x() - 0.5 * kObject.width), std::round(middle.y() - 0.5 * kObject.height),
            static_cast<double>(kObject.width), static_cast<double>(kObject.height)};
  }

  static void lay(cv::Mat& image, const cv::Mat& texture, const Eigen::Matrix3d& g) {
    cv::Mat there, mask;
    cv::warpPerspective(texture, there, test::toMatx(g), image.size(), cv::INTER_CUBIC);
    cv::warpPerspective(cv::Mat(texture.size(), CV_8UC1, cv::Scalar(255)), mask, test::toMatx(g), image.size());
    there.copyTo(image, mask > 128);
  }

  cv::Mat image() {
    cv::Mat image, grain(test::kMotionHeight, test::kMotionWidth, CV_16SC3);
    const Eigen::Matrix3d g = truth();
    cv::warpPerspective(scene_, image, test::toMatx(g * shift({-kMargin, -kMargin})), grain.size(), cv::INTER_CUBIC);
    const Eigen::Vector2d half(0.5 * (kObject.width - 1), 0.5 * (kObject.height - 1));
    lay(image, object_texture_, g * shift(middle() - half));
    // Through the image once in 4 s, at 100 px/s.
    lay(image, crossing_texture_, shift({100.0 * std::fmod(cart_.time() + 2.0, 4.0) - 40.0, 40.0}));
    random_.fill(grain, cv::RNG::NORMAL, 0.0, 2.0);
    cv::add(image, grain, image, cv::noArray(), CV_8U);
    return image;
  }

  void see(const cv::Mat& image) {
    if (!eye_) eye_.emplace(kCamera, regionAt(middle()));
    object_ = eye_->see(image, cart_.time());
    ASSERT_EQ(object_.problem, "") << cart_.time();
    object_.region = 1.0;
    object_.image_time = cart_.time();
  }

  cv::Mat scene_ = test::tissue({test::kMotionWidth + 2 * kMargin, test::kMotionHeight + 2 * kMargin}, 12);
  cv::Mat object_texture_ = test::tissue(kObject, 31), crossing_texture_ = test::tissue(kCrossing, 32);
  cv::RNG random_{7};
  SimulatedCart cart_;
  std::optional<test::ObjectEye> eye_;
  servo::TaskErrorInput object_;
};

TEST(FollowImages, AnObjectThatMovesStaysInTheMiddleWhileAnotherCrosses) {
  Following run;
  SimulatedCart& cart = run.cart();
  cart.controller.select(servo::Task::kFollow);
  run.step();
  ASSERT_EQ(cart.controller.engage(cart.input()), "");
  double squares = 0.0, worst = 0.0, wrong = 0.0, share = 1.0;
  int count = 0;
  for (int k = 0; k < 300; ++k) {
    ASSERT_NO_FATAL_FAILURE(run.step());
    wrong = std::max(wrong, run.measuringError());
    share = std::min(share, run.share());
    ASSERT_EQ(cart.output.state, servo::ControllerState::kServo) << cart.time() << ": " << cart.output.reason;
    EXPECT_EQ(cart.velocity()[2], 0.0);
    EXPECT_EQ(cart.velocity()[3], 0.0);
    if (cart.time() < 3.0) continue;
    squares += run.offset() * run.offset();
    worst = std::max(worst, run.offset());
    ++count;
  }
  std::printf("%.2f px rms off the middle, worst %.2f; seen wrong by %.2f px at most; share %.2f at least\n",
              std::sqrt(squares / count), worst, wrong, share);
  EXPECT_LT(std::sqrt(squares / count), 5.0);
}

}  // namespace
}  // namespace laparoscope_servo
