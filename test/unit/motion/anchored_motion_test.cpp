#include "laparoscope_servo/motion/anchored_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic_motion.h"

namespace laparoscope_servo::motion {
namespace {

using features::Reason;
using features::State;
using test::motionError;

constexpr double kPeriod = 0.04;

// A scene larger than the image, seen through g, which takes the first image's pixels to those of the image.
class Scene {
 public:
  cv::Mat seen(const Eigen::Matrix3d& g, unsigned seed) const {
    Eigen::Matrix3d to_scene = Eigen::Matrix3d::Identity();
    to_scene.topRightCorner<2, 1>() << -kMargin, -kMargin;
    cv::Mat image, grain(test::kMotionHeight, test::kMotionWidth, CV_16SC3);
    cv::warpPerspective(scene_, image, test::toMatx(g * to_scene), grain.size(), cv::INTER_CUBIC);
    cv::RNG rng(seed);
    rng.fill(grain, cv::RNG::NORMAL, 0.0, 2.0);
    cv::add(image, grain, image, cv::noArray(), CV_8U);
    return image;
  }

 private:
  static constexpr int kMargin = 400;
  cv::Mat scene_ = test::tissue({test::kMotionWidth + 2 * kMargin, test::kMotionHeight + 2 * kMargin}, 12);
};

Eigen::Matrix3d shift(double x, double y) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() << x, y;
  return g;
}

// To and fro, with zoom and turn.
Eigen::Matrix3d swaying(int k) {
  MotionField field;
  field.centre = test::motionFrame().centre();
  const double t = 2.0 * M_PI * k / 60.0;
  field.a << 20.0 * std::sin(t), 12.0 * std::sin(2.0 * t), 0.03 * std::sin(t), 0.04 * std::sin(t), -0.04 * std::sin(t),
      0.03 * std::sin(t), 0.0, 3e-5 * std::sin(t);
  return homographyOf(field);
}

TEST(AnchoredMotion, DoesNotDrift) {
  const Scene scene;
  AnchoredMotion motion;
  EXPECT_EQ(motion.result().state, State::kIdle);
  Eigen::Matrix3d integrated = Eigen::Matrix3d::Identity();
  for (int k = 0; k <= 60; ++k) {
    const AnchoredResult& result = motion.track(scene.seen(swaying(k), static_cast<unsigned>(k + 1)), kPeriod * k);
    ASSERT_EQ(result.state, State::kTracking) << "image " << k << ": " << reasonText(result.reason);
    EXPECT_TRUE(result.anchored) << "image " << k;
    EXPECT_LT(motionError(result.g, swaying(k)), 0.15) << "image " << k;
    EXPECT_LT(result.expected_error, 0.1);
    if (k > 0) integrated = motion.step().g * integrated;
  }
  EXPECT_GT(motionError(integrated, swaying(60)), 2.0 * motionError(motion.result().g, swaying(60)));
}

// Pushed so far that nothing of the first image is in view, and back.
TEST(AnchoredMotion, AViewThatWasLeftIsFoundAgain) {
  const Scene scene;
  AnchoredMotion motion;
  double worst_error = 0.0, least_in_view = 1.0;
  for (int k = 0; k <= 100; ++k) {
    const double far = 350.0 * std::pow(std::sin(M_PI * k / 100.0), 2);
    const AnchoredResult& result =
        motion.track(scene.seen(shift(far, 0.2 * far), static_cast<unsigned>(k + 1)), kPeriod * k);
    ASSERT_EQ(result.state, State::kTracking) << "image " << k << ": " << reasonText(result.reason);
    worst_error = std::max(worst_error, motionError(result.g, shift(far, 0.2 * far)));
    least_in_view = std::min(least_in_view, result.in_view);
    if (result.in_view < 0.1) {
      EXPECT_FALSE(result.anchored) << "image " << k;
      EXPECT_GT(result.since_anchored, 0.0);
    }
  }
  EXPECT_EQ(least_in_view, 0.0);
  EXPECT_TRUE(motion.result().anchored);
  EXPECT_LT(motionError(motion.result().g, shift(0.0, 0.0)), 0.1);
  EXPECT_LT(worst_error, 5.0);
}

TEST(AnchoredMotion, IsFoundAgainAfterTheChainWasBroken) {
  MotionConfig config;
  config.state.confirmations = 2;
  const Scene scene;
  AnchoredMotion motion(config);
  const cv::Mat dark(test::kMotionHeight, test::kMotionWidth, CV_8UC3, cv::Scalar::all(0));
  for (int k = 0; k < 5; ++k) motion.track(scene.seen(shift(3.0 * k, 0.0), static_cast<unsigned>(k + 1)), kPeriod * k);
  EXPECT_EQ(motion.track(dark, 0.20).state, State::kSearching);
  EXPECT_TRUE(std::isinf(motion.result().expected_error));
  EXPECT_TRUE(std::isinf(motion.result().covariance(0, 0)));
  State state = State::kSearching;
  for (int k = 6; k < 10; ++k)
    state = motion.track(scene.seen(shift(8.0, 5.0), static_cast<unsigned>(k)), kPeriod * k).state;
  EXPECT_EQ(state, State::kTracking) << reasonText(motion.result().reason);
  EXPECT_LT(motionError(motion.result().g, shift(8.0, 5.0)), 0.1);
}

// Another place is not taken for the anchor.
TEST(AnchoredMotion, IsNotFoundWhereItIsNot) {
  const Scene scene;
  AnchoredMotion motion;
  for (int k = 0; k < 3; ++k) motion.track(scene.seen(shift(0.0, 0.0), static_cast<unsigned>(k + 1)), kPeriod * k);
  for (int k = 3; k < 12; ++k) {
    const AnchoredResult& result =
        motion.track(scene.seen(shift(-390.0, -390.0), static_cast<unsigned>(k + 1)), kPeriod * k);
    EXPECT_NE(result.state, State::kTracking) << "image " << k;
    EXPECT_FALSE(result.anchored);
  }
}

TEST(AnchoredMotion, AnotherSizeOrTimeThatJumpsBackIsAnotherAnchor) {
  const Scene scene;
  AnchoredMotion motion;
  for (int k = 0; k < 3; ++k)
    motion.track(scene.seen(shift(5.0 * k, 0.0), static_cast<unsigned>(k + 1)), 1.0 + kPeriod * k);
  const AnchoredResult& result = motion.track(scene.seen(shift(15.0, 0.0), 7), 0.5);
  EXPECT_EQ(result.state, State::kTracking);
  EXPECT_EQ(result.g, Eigen::Matrix3d::Identity());
  motion.track(scene.seen(shift(18.0, 0.0), 8), 0.54);
  EXPECT_LT(motionError(motion.result().g, shift(3.0, 0.0)), 0.1);
  motion.reset();
  EXPECT_EQ(motion.result().state, State::kIdle);
  EXPECT_EQ(motion.result().reason, Reason::kReset);
}

TEST(AnchoredMotion, RefusesWhatItCannotUseAndGoesOn) {
  const Scene scene;
  AnchoredMotion motion;
  for (int k = 0; k < 2; ++k) motion.track(scene.seen(shift(2.0 * k, 0.0), static_cast<unsigned>(k + 1)), kPeriod * k);
  EXPECT_THROW(motion.track(cv::Mat(240, 320, CV_16UC1, cv::Scalar(1)), 0.08), std::invalid_argument);
  EXPECT_EQ(motion.track(scene.seen(shift(4.0, 0.0), 9), 0.08).state, State::kTracking);
  MotionConfig wrong;
  wrong.max_error = -1.0;
  EXPECT_THROW(AnchoredMotion{wrong}, std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::motion
