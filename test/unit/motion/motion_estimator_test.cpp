#include "motion/motion_estimator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic_motion.h"

namespace laparoscope_servo::motion {
namespace {

using features::Reason;
using test::motionError;
using test::motionFrame;
using test::movingTissue;
using test::usualMotion;

const Eigen::Matrix3d kRest = Eigen::Matrix3d::Identity();

class MotionEstimatorTest : public testing::Test {
 protected:
  const MotionEstimate& estimate(const cv::Mat& reference, const cv::Mat& current, const Eigen::Matrix3d& start = kRest,
                                 const cv::Mat& mask = cv::Mat()) {
    reference_.take(reference, cv::Mat(), config_);
    current_.take(current, mask, config_);
    if (!estimator_) estimator_.emplace(config_);
    estimator_->setReference(reference_);
    return estimator_->estimate(reference_, current_, {start}, region_, whole_);
  }

  MotionConfig config_;
  geometry::Quadrilateral region_ = motionFrame().corners();
  bool whole_ = true;
  std::optional<MotionEstimator> estimator_;
  MotionImage reference_, current_;
};

TEST_F(MotionEstimatorTest, BelievesWhatMostOfThePictureFollows) {
  const MotionField field = usualMotion();
  const MotionEstimate& found = estimate(movingTissue(0, field), movingTissue(1, field));
  ASSERT_EQ(found.why, Reason::kNone) << features::reasonText(found.why);
  EXPECT_LT(motionError(found.at.g, homographyOf(field)), 0.1);
  EXPECT_GT(found.share, 0.9);
  EXPECT_GT(found.usable, 0.9);
  EXPECT_GT(found.expected_error, 0.0);
  EXPECT_LT(found.expected_error, config_.max_error);
  EXPECT_GT(found.covariance(0, 0), 0.0);
}

// Beside the bound of each reason, with everything else as before.
TEST_F(MotionEstimatorTest, SaysWhyItDoesNotBelieve) {
  const MotionField field = usualMotion();
  const cv::Mat first = movingTissue(0, field), second = movingTissue(1, field);
  const cv::Mat plain(first.size(), first.type(), cv::Scalar::all(120));
  EXPECT_EQ(estimate(plain, plain).why, Reason::kNoTexture);
  EXPECT_EQ(estimate(first, plain).why, Reason::kNothingDominates) << "what was there is gone";
  EXPECT_EQ(estimate(first, second, kRest, cv::Mat(first.size(), CV_8UC1, cv::Scalar(255))).why,
            Reason::kNothingUsable);
  EXPECT_EQ(estimate(first, movingTissue(1, field, 77)).why, Reason::kNothingDominates) << "other tissue";
  EXPECT_EQ(estimate(first, second).why, Reason::kNone) << "none of it lasts";
  const double expected = estimate(first, second).expected_error;
  for (const double factor : {0.9, 1.1}) {
    config_.max_error = factor * expected;
    estimator_.reset();
    EXPECT_EQ(estimate(first, second).why, factor < 1.0 ? Reason::kUncertain : Reason::kNone) << factor;
  }
}

// A quarter of a region has to be in the image.
TEST_F(MotionEstimatorTest, ARegionHasToBeInTheImage) {
  const MotionField field = usualMotion();
  whole_ = false;
  for (const double left : {280.0, 305.0}) {
    region_ = geometry::Rectangle{left, 60.0, 100.0, 100.0}.corners();
    const Reason why = estimate(movingTissue(0, field), movingTissue(1, field)).why;
    EXPECT_EQ(why == Reason::kOutside, left > 295.0) << left << ": " << features::reasonText(why);
  }
}

// By the scale that the images before have shown: what moves otherwise is not taken for noise.
TEST_F(MotionEstimatorTest, KnowsByTheImagesBeforeWhatMayScatter) {
  const MotionField field = usualMotion();
  cv::Mat covered = movingTissue(2, field);
  test::cover(covered, 2, {20, 20, 150, 200}, {-9.0, 4.0});
  ASSERT_EQ(estimate(movingTissue(0, field), movingTissue(1, field)).why, Reason::kNone);
  const MotionEstimate found = estimate(movingTissue(1, field), covered);
  EXPECT_EQ(found.why, Reason::kNone) << features::reasonText(found.why);
  MotionField both = field;
  both.a *= 2.0;
  EXPECT_LT(motionError(found.at.g, homographyOf(both) * homographyOf(field).inverse()), 0.3);
  EXPECT_LT(found.share, 0.9) << "the cover does not follow";
}

// After an image that is not believed it begins as a new one does, to the last digit.
TEST_F(MotionEstimatorTest, ForgetsWithWhatItDoesNotBelieve) {
  const MotionField field = usualMotion();
  const cv::Mat first = movingTissue(0, field), second = movingTissue(1, field);
  const MotionEstimate fresh = estimate(first, second);
  const MotionEstimate knowing = estimate(first, second);
  EXPECT_NE(knowing.at.iterations, 0);
  EXPECT_NE(estimate(first, cv::Mat(first.size(), first.type(), cv::Scalar::all(120))).why, Reason::kNone);
  EXPECT_EQ(estimator_->support().share(), 0.0) << "nothing is known of that image";
  EXPECT_EQ(estimate(first, second).at.g, fresh.at.g);
  estimator_->forget();
  EXPECT_EQ(estimate(first, second).at.g, fresh.at.g);
}

}  // namespace
}  // namespace laparoscope_servo::motion
