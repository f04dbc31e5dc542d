#include "laparoscope_servo/motion/dominant_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic_motion.h"

namespace laparoscope_servo::motion {
namespace {

using features::Reason;
using features::State;
using test::motionError;
using test::movingTissue;
using test::usualMotion;

constexpr double kPeriod = 0.04;

TEST(DominantMotion, FollowsASequence) {
  for (const Model model : {Model::kConstant, Model::kAffine, Model::kQuadratic}) {
    MotionConfig config;
    config.model = model;
    DominantMotion motion(config);
    const MotionField field = usualMotion(model);
    EXPECT_EQ(motion.track(movingTissue(0, field), 0.0).state, State::kIdle);
    EXPECT_EQ(motion.result().reason, Reason::kFirstImage);
    for (int k = 1; k < 5; ++k) {
      const MotionResult& result = motion.track(movingTissue(k, field), kPeriod * k);
      ASSERT_EQ(result.state, State::kTracking) << reasonText(result.reason);
      EXPECT_LT(motionError(result.g, homographyOf(field)), 0.1) << "model " << static_cast<int>(model);
      EXPECT_LT(motionError(homographyOf(result.field), result.g), 1e-9);
      EXPECT_EQ(result.interval, kPeriod * k - kPeriod * (k - 1));
      EXPECT_GT(result.share, 0.9);
      EXPECT_LT(result.expected_error, 0.1);
      EXPECT_GT(result.usable, 0.99);
    }
  }
}

// Nearly half of the image moves as one, too.
TEST(DominantMotion, TheGreaterPartDecides) {
  DominantMotion motion;
  const MotionField field = usualMotion();
  for (int k = 0; k < 6; ++k) {
    cv::Mat image = movingTissue(k, field);
    test::cover(image, k, cv::Rect(20, 20, 140, 200), {-2.0, 3.0});
    const MotionResult& result = motion.track(image, kPeriod * k);
    if (k == 0) continue;
    ASSERT_EQ(result.state, State::kTracking) << "image " << k << ": " << reasonText(result.reason);
    EXPECT_LT(motionError(result.g, homographyOf(field)), 0.2) << "image " << k;
    EXPECT_EQ(motion.support()(7, 2), 0) << "within what moves otherwise";
    EXPECT_EQ(motion.support()(7, 8), 255);
  }
}

TEST(DominantMotion, AMaskTakesAwayWhatItCovers) {
  DominantMotion motion;
  const MotionField field = usualMotion();
  for (int k = 0; k < 4; ++k) {
    cv::Mat image = movingTissue(k, field);
    test::cover(image, k, cv::Rect(0, 0, 200, 240), {0.0, 4.0});
    cv::Mat mask = cv::Mat::zeros(image.size(), CV_8UC1);
    mask(cv::Rect(0, 0, 200, 240)).setTo(255);
    const MotionResult& result = motion.track(image, kPeriod * k, std::nullopt, mask);
    if (k == 0) continue;
    ASSERT_EQ(result.state, State::kTracking) << reasonText(result.reason);
    EXPECT_LT(motionError(result.g, homographyOf(field)), 0.3);
    EXPECT_NEAR(result.usable, 120.0 / 320.0, 0.05);
  }
}

TEST(DominantMotion, AHighlightThatStandsStillDoesNotHold) {
  MotionConfig config;
  config.model = Model::kConstant;
  DominantMotion motion(config);
  const MotionField field = usualMotion(Model::kConstant);
  for (int k = 0; k < 4; ++k) {
    cv::Mat image = movingTissue(k, field);
    for (int i = 0; i < 12; ++i) image(cv::Rect(10 + 26 * i, 20 + 17 * i % 200, 8, 8)).setTo(cv::Scalar::all(255));
    const MotionResult& result = motion.track(image, kPeriod * k);
    if (k == 0) continue;
    EXPECT_LT(motionError(result.g, homographyOf(field)), 0.05);
    EXPECT_LT(result.usable, 1.0);
  }
}

TEST(DominantMotion, TellsTheLight) {
  DominantMotion motion;
  const MotionField field = usualMotion();
  motion.track(movingTissue(0, field), 0.0);
  const MotionResult& result = motion.track(movingTissue(1, field, 3, 0.9, 8.0), kPeriod);
  ASSERT_EQ(result.state, State::kTracking);
  EXPECT_NEAR(result.gain, 1.0 / 0.9, 0.03);
}

TEST(DominantMotion, SaysWhenNothingDominates) {
  DominantMotion motion;
  for (int k = 0; k < 3; ++k) {
    const MotionResult& result =
        motion.track(movingTissue(0, usualMotion(), static_cast<unsigned>(30 + k)), kPeriod * k);
    if (k == 0) continue;
    EXPECT_EQ(result.state, State::kSearching);
    EXPECT_EQ(result.reason, Reason::kNothingDominates) << reasonText(result.reason);
    EXPECT_TRUE(std::isinf(result.expected_error));
    EXPECT_TRUE(std::isinf(result.covariance(0, 0)));
  }
}

TEST(DominantMotion, SaysWhenThereIsNoTexture) {
  DominantMotion motion;
  cv::RNG rng(4);
  for (int k = 0; k < 3; ++k) {
    cv::Mat plain(240, 320, CV_8UC3);
    rng.fill(plain, cv::RNG::NORMAL, cv::Scalar(90, 100, 150), cv::Scalar(2, 2, 2));
    motion.track(plain, kPeriod * k);
  }
  EXPECT_EQ(motion.result().state, State::kSearching);
  EXPECT_EQ(motion.result().reason, Reason::kNoTexture) << reasonText(motion.result().reason);
}

TEST(DominantMotion, SaysWhenAllIsHighlightOrDark) {
  for (const int value : {0, 255}) {
    DominantMotion motion;
    for (int k = 0; k < 2; ++k) motion.track(cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(value)), kPeriod * k);
    EXPECT_EQ(motion.result().state, State::kSearching);
    EXPECT_EQ(motion.result().reason, Reason::kNothingUsable) << value;
  }
}

TEST(DominantMotion, IsLostAfterAWhileAndHasToBeConfirmed) {
  MotionConfig config;
  config.state.max_search_time = 1.0;
  config.state.confirmations = 2;
  DominantMotion motion(config);
  const MotionField field = usualMotion();
  const cv::Mat dark(240, 320, CV_8UC3, cv::Scalar::all(0));
  motion.track(movingTissue(0, field), 0.0);
  EXPECT_EQ(motion.track(movingTissue(1, field), 0.04).state, State::kTracking);
  EXPECT_EQ(motion.track(dark, 0.08).state, State::kSearching);
  EXPECT_EQ(motion.track(dark, 1.5).state, State::kLost);
  EXPECT_EQ(motion.track(movingTissue(2, field), 1.54).state, State::kLost);
  EXPECT_EQ(motion.track(movingTissue(3, field), 1.58).state, State::kLost);
  EXPECT_EQ(motion.result().reason, Reason::kNotConfirmed);
  EXPECT_EQ(motion.track(movingTissue(4, field), 1.62).state, State::kTracking);
}

// A small part of the image, which moves otherwise than most of it.
TEST(DominantMotion, ARegionGoesAlongWithItsMotion) {
  MotionConfig config;
  config.model = Model::kConstant;
  DominantMotion motion(config);
  const MotionField field = usualMotion(Model::kConstant);
  const Eigen::Vector2d step(-4.0, 2.0);
  for (int k = 0; k < 8; ++k) {
    cv::Mat image = movingTissue(k, field);
    test::cover(image, k, cv::Rect(180, 60, 100, 90), step);
    if (k == 0) {
      motion.begin(image, 0.0, geometry::Rectangle{190.0, 70.0, 80.0, 70.0});
      continue;
    }
    const MotionResult& result = motion.track(image, kPeriod * k);
    ASSERT_EQ(result.state, State::kTracking) << reasonText(result.reason);
    EXPECT_LT((result.field.a.head<2>() - step).norm(), 0.1);
    EXPECT_LT((result.region[0] - (Eigen::Vector2d(190.0, 70.0) + k * step)).norm(), 0.1 * k);
  }
}

// The least region, of 3 % of the image, in each model and on an image that is halved otherwise.
TEST(DominantMotion, ASmallRegionIsSeenByItsOwnPixels) {
  for (const Model model : {Model::kConstant, Model::kAffine, Model::kQuadratic}) {
    MotionConfig config;
    config.model = model;
    config.max_pixels = 40000;
    DominantMotion motion(config);
    const MotionField field = usualMotion();
    const Eigen::Vector2d step(-4.0, 2.0);
    for (int k = 0; k < 20; ++k) {
      cv::Mat image = movingTissue(k, field);
      test::cover(image, k, cv::Rect(180, 60, 52, 52), step);
      if (k == 0) {
        motion.begin(image, 0.0, geometry::Rectangle{182.0, 62.0, 48.0, 48.0});
        continue;
      }
      const MotionResult& result = motion.track(image, kPeriod * k);
      ASSERT_EQ(result.state, State::kTracking)
          << k << ", model " << static_cast<int>(model) << ": " << reasonText(result.reason);
      for (const Eigen::Vector2d& corner : result.region)
        EXPECT_LT((result.field.at(corner) - step).norm(), 0.2 + 5.0 * result.expected_error) << k;
      Eigen::Vector2d middle = Eigen::Vector2d::Zero();
      for (const Eigen::Vector2d& corner : result.region) middle += 0.25 * corner;
      EXPECT_LT((middle - Eigen::Vector2d(205.5, 85.5) - k * step).norm(), 1.0) << k;
    }
  }
}

TEST(DominantMotion, ARegionThatLeavesTheImageIsOutside) {
  MotionConfig config;
  config.model = Model::kConstant;
  DominantMotion motion(config);
  MotionField field = usualMotion(Model::kConstant);
  field.a.head<2>() = Eigen::Vector2d(8.0, 0.0);
  Reason reason = Reason::kNone;
  int kept = 0;
  for (int k = 0; k < 14 && reason != Reason::kOutside; ++k) {
    const cv::Mat image = movingTissue(k, field);
    if (k == 0) {
      motion.begin(image, 0.0, geometry::Rectangle{220.0, 80.0, 90.0, 80.0});
      continue;
    }
    reason = motion.track(image, kPeriod * k).reason;
    kept += reason == Reason::kNone ? 1 : 0;
  }
  EXPECT_EQ(reason, Reason::kOutside) << reasonText(reason);
  EXPECT_GE(kept, 6);
}

// Faster than the votes reach, and a homography that somebody else knows.
TEST(DominantMotion, StartsFromAMotionThatIsGiven) {
  MotionField field = usualMotion();
  field.a.head<2>() = Eigen::Vector2d(60.0, -50.0);
  DominantMotion motion;
  motion.track(movingTissue(0, field), 0.0);
  const MotionResult& result = motion.track(movingTissue(1, field), kPeriod, homographyOf(field));
  ASSERT_EQ(result.state, State::kTracking) << reasonText(result.reason);
  EXPECT_LT(motionError(result.g, homographyOf(field)), 0.3);
}

TEST(DominantMotion, TheSameImagesGiveTheSameNumbers) {
  const MotionField field = usualMotion();
  DominantMotion first, second;
  for (int k = 0; k < 4; ++k) {
    const cv::Mat image = movingTissue(k, field);
    const MotionResult a = first.track(image, kPeriod * k), b = second.track(image, kPeriod * k);
    EXPECT_EQ(a.g, b.g);
    EXPECT_EQ(a.covariance, b.covariance);
    EXPECT_EQ(a.share, b.share);
  }
}

}  // namespace
}  // namespace laparoscope_servo::motion
