// What is remembered from pair to pair of images: velocity, region, whether the last pair was believed.
#include "motion/motion_sequence.h"

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

class MotionSequenceTest : public testing::Test {
 protected:
  // Three images, 0.04 s apart, of which two pairs move as `field_`.
  void follow(const std::optional<geometry::Rectangle>& region = std::nullopt) {
    sequence_.begin(movingTissue(0, field_), 0.0, region, {});
    for (const int k : {1, 2}) ASSERT_EQ(pair(movingTissue(k, field_), 0.04 * k).state, State::kTracking);
  }
  const MotionResult& pair(const cv::Mat& image, double stamp,
                           const std::optional<Eigen::Matrix3d>& motion = std::nullopt) {
    return sequence_.track(image, stamp, motion, {});
  }
  // The motion seen, times so much.
  Eigen::Matrix3d seenTimes(const MotionField& seen, double factor) const {
    MotionField field = seen;
    field.a *= factor;
    return homographyOf(field);
  }

  MotionConfig config_;
  MotionSequence sequence_{config_};
  MotionField field_ = usualMotion();
  const cv::Mat dark_ = cv::Mat::zeros(test::kMotionHeight, test::kMotionWidth, movingTissue(0, field_).type());
};

TEST_F(MotionSequenceTest, AnImageThatShowsNothingIsExpectedToMoveOnWithLessSpeed) {
  follow();
  const MotionField seen = sequence_.result().field;
  // Twice the time to the next image is twice the way.
  EXPECT_LT(motionError(pair(dark_, 0.16).g, seenTimes(seen, 2.0 * config_.velocity_damping)), 1e-9);
  EXPECT_NE(sequence_.result().state, State::kTracking);
  EXPECT_FALSE(sequence_.believed());
  EXPECT_TRUE(std::isinf(sequence_.result().expected_error));
  EXPECT_LT(motionError(pair(dark_, 0.20).g, seenTimes(seen, std::pow(config_.velocity_damping, 2))), 1e-9);
}

TEST_F(MotionSequenceTest, AMotionThatIsGivenIsExpectedInsteadWhateverItsScale) {
  follow();
  MotionField other = usualMotion();
  other.a *= -2.0;
  const Eigen::Matrix3d given = homographyOf(other);
  EXPECT_LT(motionError(pair(dark_, 0.12, 5.0 * given).g, given), 1e-9);
  EXPECT_NEAR(sequence_.result().g.determinant(), 1.0, 1e-9);
  const Eigen::Matrix3d mirrored = Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal();
  EXPECT_GT(motionError(pair(dark_, 0.16, mirrored).g, mirrored), 100.0) << "a camera does not mirror";
}

TEST_F(MotionSequenceTest, TheRegionGoesAlongWithEachPair) {
  const geometry::Rectangle region{100.0, 80.0, 100.0, 80.0};
  follow(region);
  const geometry::Quadrilateral expected =
      geometry::apply(homographyOf(field_) * homographyOf(field_), region.corners());
  EXPECT_LT(geometry::largestDistance(sequence_.result().region, expected), 0.3);
  EXPECT_TRUE(sequence_.believed());
  EXPECT_TRUE(sequence_.covariance().allFinite());
}

TEST_F(MotionSequenceTest, ResetForgetsVelocityAndRegion) {
  follow(geometry::Rectangle{100.0, 80.0, 100.0, 80.0});
  sequence_.reset(Reason::kNothingSelected);
  EXPECT_EQ(sequence_.result().state, State::kIdle);
  EXPECT_FALSE(sequence_.believed());
  EXPECT_EQ(pair(movingTissue(5, field_), 1.0).reason, Reason::kFirstImage);
  EXPECT_LT(geometry::largestDistance(sequence_.result().region, test::motionFrame().corners()), 1e-9);
  EXPECT_LT(motionError(pair(dark_, 1.04).g, Eigen::Matrix3d::Identity()), 1e-9) << "as if it stood still";
}

TEST_F(MotionSequenceTest, WhatIsRefusedLeavesTheSequenceAsItWas) {
  follow();
  EXPECT_THROW(pair(cv::Mat(50, 50, CV_8UC1, cv::Scalar(9)), 0.12), std::invalid_argument);
  EXPECT_THROW(pair(movingTissue(3, field_), std::nan("")), std::invalid_argument);
  const geometry::Rectangle nowhere{std::nan(""), 0.0, 100.0, 100.0};
  EXPECT_THROW(sequence_.begin(movingTissue(3, field_), 0.12, nowhere, {}), std::invalid_argument);
  EXPECT_EQ(pair(movingTissue(3, field_), 0.12).state, State::kTracking);
  EXPECT_LT(motionError(sequence_.result().g, homographyOf(field_)), 0.1);
}

}  // namespace
}  // namespace laparoscope_servo::motion
