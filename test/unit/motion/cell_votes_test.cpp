#include "motion/cell_votes.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>

#include "support/synthetic_motion.h"

namespace laparoscope_servo::motion {
namespace {

constexpr double kSigma = 2.0;  // grey levels, of the residuals

class CellVotesTest : public testing::Test {
 protected:
  // The sums of level 1 at the identity, without weights.
  std::optional<geometry::Vector8d> votedFor(const cv::Mat& reference, const cv::Mat& current,
                                             Model model = Model::kQuadratic) {
    image::RegionPyramid before, after;
    for (auto [pyramid, image] : {std::pair(&before, &reference), std::pair(&after, &current)})
      pyramid->build(*image, cv::Rect(0, 0, image->cols, image->rows), 2, image::kLuma);
    tracking::EsmLevel level(before, test::motionFrame(), 1);
    image::Patch& warped = level.planes[0].warped;
    for (int j = 0; j < level.height; ++j) std::copy_n(after.level(1).ptr<float>(j), level.width, warped.row(j));
    warped.extrapolate();
    equations_.sum(level, test::motionFrame(), tracking::Light::kGlobal, 1.0, 0.0);
    return votes_.fit(level, equations_.cells(), kSigma, model);
  }

  tracking::LevelEquations equations_;
  CellVotes votes_;
};

// A tenth of a usual motion: what is left after a coarse fit.
MotionField littleMotion() {
  MotionField field = test::usualMotion();
  field.a *= 0.2;
  return field;
}

double errorOf(const geometry::Vector8d& a, const MotionField& truth) {
  MotionField field = truth;
  field.a = a;
  double worst = 0.0;
  for (const Eigen::Vector2d& corner : test::motionFrame().corners())
    worst = std::max(worst, (field.at(corner) - truth.at(corner)).norm());
  return worst;
}

TEST_F(CellVotesTest, FindWhatIsLeft) {
  const MotionField field = littleMotion();
  const auto a = votedFor(test::movingTissue(0, field), test::movingTissue(1, field));
  ASSERT_TRUE(a);
  EXPECT_LT(errorOf(*a, field), 0.4);
}

TEST_F(CellVotesTest, KeepToTheModel) {
  const MotionField field = littleMotion();
  const auto a = votedFor(test::movingTissue(0, field), test::movingTissue(1, field), Model::kAffine);
  ASSERT_TRUE(a);
  EXPECT_EQ(a->tail<2>().norm(), 0.0);
  const auto shift = votedFor(test::movingTissue(0, field), test::movingTissue(1, field), Model::kConstant);
  ASSERT_TRUE(shift);
  EXPECT_EQ(shift->tail<6>().norm(), 0.0);
}

// A fit to all of them would be off by 0.4 of the difference between the two.
TEST_F(CellVotesTest, TheGreaterPartDecides) {
  const MotionField field = littleMotion();
  cv::Mat before = test::movingTissue(0, field), after = test::movingTissue(1, field);
  const cv::Rect box(10, 10, 130, 220);
  test::cover(before, 0, box, {-1.0, 1.5});
  test::cover(after, 1, box, {-1.0, 1.5});
  const auto a = votedFor(before, after);
  ASSERT_TRUE(a);
  MotionField found = field;
  found.a = *a;
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(200.0, 40.0), Eigen::Vector2d(300.0, 200.0)})
    EXPECT_LT((found.at(p) - field.at(p)).norm(), 0.8) << "the tolerance of votes";
}

TEST_F(CellVotesTest, NobodyVotesWithoutTexture) {
  const cv::Mat plain(240, 320, CV_8UC1, cv::Scalar(100));
  EXPECT_FALSE(votedFor(plain, plain));
}

// The derivative of the squares of a cell's residuals by a shift of the cell.
TEST(CellShift, IsAboutTheMeans) {
  tracking::CellSums cell{};
  cell.w = 4.0f;
  cell.x = 8.0f;
  cell.y = 4.0f;
  cell.xx = 40.0f;
  cell.xy = 12.0f;
  cell.yy = 20.0f;
  cell.r = 12.0f;
  cell.xr = 30.0f;
  cell.yr = 10.0f;
  const CellShift shift = shiftOf(cell);
  Eigen::Matrix2d matrix;
  matrix << 40.0 - 16.0, 12.0 - 8.0, 12.0 - 8.0, 20.0 - 4.0;
  EXPECT_LT((shift.matrix - matrix / 4.0).norm(), 1e-12);
  EXPECT_LT((shift.vector + Eigen::Vector2d(30.0 - 24.0, 10.0 - 12.0) / 2.0).norm(), 1e-12);
}

}  // namespace
}  // namespace laparoscope_servo::motion
