#include "motion/motion_aligner.h"

#include <gtest/gtest.h>

#include "support/synthetic_motion.h"

namespace laparoscope_servo::motion {
namespace {

using test::motionError;
using test::movingTissue;
using test::usualMotion;

MotionConfig configOf(Model model) {
  MotionConfig config;
  config.model = model;
  return config;
}

// As under a lamp that goes along with the camera: from twice as bright on the left to dark on the right.
cv::Mat shaded(cv::Mat image) {
  image.forEach<cv::Vec3b>([&](cv::Vec3b& pixel, const int* at) {
    const double light = 1.4 - 1.1 * at[1] / image.cols;
    for (int k = 0; k < 3; ++k) pixel[k] = cv::saturate_cast<uchar>(light * pixel[k]);
  });
  return image;
}

class MotionAlignerTest : public testing::Test {
 protected:
  Alignment align(const cv::Mat& reference, const cv::Mat& current, const MotionConfig& config,
                  const Eigen::Matrix3d& start = Eigen::Matrix3d::Identity()) {
    aligner_.emplace(config);
    reference_.take(reference, cv::Mat(), config);
    current_.take(current, cv::Mat(), config);
    aligner_->setReference(reference_);
    aligner_->setUsable(reference_, current_, start, nullptr);
    return aligner_->align(current_, {start}, {});
  }

  std::optional<MotionAligner> aligner_;
  MotionImage reference_, current_;
};

TEST_F(MotionAlignerTest, FindsEachModelsMotion) {
  for (const Model model : {Model::kConstant, Model::kAffine, Model::kQuadratic}) {
    const MotionField field = usualMotion(model);
    const Alignment at = align(movingTissue(0, field), movingTissue(1, field), configOf(model));
    ASSERT_TRUE(at.determined);
    EXPECT_LT(motionError(at.g, homographyOf(field)), 0.06) << "model " << static_cast<int>(model);
    EXPECT_NEAR(at.g.determinant(), 1.0, 1e-9);
  }
}

// What the model does not have stays away, though the picture has it.
TEST_F(MotionAlignerTest, KeepsToItsModel) {
  const MotionField field = usualMotion();
  const Alignment affine = align(movingTissue(0, field), movingTissue(1, field), configOf(Model::kAffine));
  EXPECT_LT((affine.g.row(2).head<2>().norm()), 1e-12);
  const Alignment constant = align(movingTissue(0, field), movingTissue(1, field), configOf(Model::kConstant));
  EXPECT_LT((constant.g.topLeftCorner<2, 2>() - Eigen::Matrix2d::Identity()).norm(), 1e-12);
}

TEST_F(MotionAlignerTest, FindsGainAndOffset) {
  const MotionField field = usualMotion();
  const Alignment at =
      align(movingTissue(0, field), movingTissue(1, field, 3, 0.85, 12.0), configOf(Model::kQuadratic));
  EXPECT_LT(motionError(at.g, homographyOf(field)), 0.1);
  EXPECT_NEAR(at.gain, 1.0 / 0.85, 0.03);
  EXPECT_NEAR(at.offset, -12.0 / 0.85, 4.0);
}

// With one gain and one offset for the whole image it is 0.25 px off.
TEST_F(MotionAlignerTest, ShadingThatStaysInTheImageDoesNotBiasTheMotion) {
  MotionField field = usualMotion();
  field.a.head<2>() = Eigen::Vector2d(40.0, 10.0);
  const Eigen::Matrix3d truth = homographyOf(field);
  const Alignment at =
      align(shaded(movingTissue(0, field)), shaded(movingTissue(1, field)), configOf(Model::kQuadratic), truth);
  EXPECT_LT(motionError(at.g, truth), 0.15);
}

TEST_F(MotionAlignerTest, StartsWhereItIsExpected) {
  MotionField field = usualMotion();
  field.a.head<2>() = Eigen::Vector2d(42.0, -30.0);
  const Eigen::Matrix3d truth = homographyOf(field);
  const Alignment at = align(movingTissue(0, field), movingTissue(1, field), configOf(Model::kQuadratic), truth);
  EXPECT_LT(motionError(at.g, truth), 0.1);
}

// The start that is given is off, and so is rest: the votes find it.
TEST_F(MotionAlignerTest, StartsWhereTheBlocksVoteFor) {
  MotionField field = usualMotion();
  field.a.head<2>() = Eigen::Vector2d(10.0, 10.0);
  Eigen::Matrix3d wrong = Eigen::Matrix3d::Identity();
  wrong.topRightCorner<2, 1>() << -12.0, -12.0;
  const Alignment at = align(movingTissue(0, field), movingTissue(1, field), configOf(Model::kQuadratic), wrong);
  EXPECT_LT(motionError(at.g, homographyOf(field)), 0.1);
}

TEST_F(MotionAlignerTest, SaysWhenNothingDeterminesTheMotion) {
  const cv::Mat plain(240, 320, CV_8UC1, cv::Scalar(100));
  EXPECT_FALSE(align(plain, plain, configOf(Model::kQuadratic)).determined);
}

// The mean of normalised squared errors over noise: 1 where the covariance is right. A shift's is that of sampling, an
// upper bound.
TEST_F(MotionAlignerTest, CovarianceIsThatOfTheErrors) {
  for (const Model model : {Model::kConstant, Model::kQuadratic}) {
    const MotionField field = usualMotion(model);
    const int unknowns = parametersOf(model);
    double sum = 0.0;
    constexpr int kTrials = 12;
    for (int k = 0; k < kTrials; ++k) {
      const unsigned seed = static_cast<unsigned>(20 + k);
      const Alignment at = align(movingTissue(0, field, seed), movingTissue(1, field, seed), configOf(model));
      const auto covariance = aligner_->covariance();
      ASSERT_TRUE(covariance);
      EXPECT_EQ(covariance->bottomRightCorner(8 - unknowns, 8).norm(), 0.0);
      const Eigen::VectorXd error = (fieldOf(at.g, field.centre).a - field.a).head(unknowns);
      const Eigen::MatrixXd c = covariance->topLeftCorner(unknowns, unknowns);
      sum += error.dot(c.ldlt().solve(error)) / unknowns;
    }
    if (model == Model::kQuadratic) {
      EXPECT_GT(sum / kTrials, 0.3);
    }
    EXPECT_LT(sum / kTrials, 3.0) << "model " << static_cast<int>(model);
  }
}

TEST_F(MotionAlignerTest, ACoarserFinestLevelHasFewerPixels) {
  const MotionField field = usualMotion();
  MotionConfig config;
  config.max_pixels = 20000;
  const Alignment at = align(movingTissue(0, field), movingTissue(1, field), config);
  EXPECT_EQ(aligner_->level(0).width, 160);
  EXPECT_LT(motionError(at.g, homographyOf(field)), 0.15);
}

}  // namespace
}  // namespace laparoscope_servo::motion
