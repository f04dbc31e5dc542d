#include "tracking/align/shift_fit.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "tracking/esm/covariance.h"

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {100, 80, 120, 100};
constexpr double kSide = 24.0;

// 6 x 6 blocks that a homography takes elsewhere, each with so much noise [px].
std::vector<BlockShift> shiftsOf(const geometry::Vector8d& x, double noise, unsigned seed = 1) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const Eigen::Matrix3d n = templateFromPixels(kRoi);
  const Eigen::Matrix3d g = n.inverse() * geometry::sl3Exp(x) * n;
  std::vector<BlockShift> shifts;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      BlockShift s;
      s.centre << kRoi.x + 12.0 + 19.0 * column, kRoi.y + 12.0 + 15.0 * row;
      s.shift = geometry::apply(g, s.centre) - s.centre + noise * Eigen::Vector2d(normal(generator), normal(generator));
      s.correlation = 1.0;
      s.confident = true;
      shifts.push_back(s);
    }
  }
  return shifts;
}

geometry::Vector8d someMotion() {
  geometry::Vector8d x;
  x << 0.03, -0.02, 0.01, -0.015, 0.01, 0.005, 0.004, -0.003;
  return x;
}

double cornersApart(const geometry::Vector8d& a, const geometry::Vector8d& b) {
  const geometry::Sl3Steps steps(templateFromPixels(kRoi));
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  return geometry::cornerDistance(steps.plus(identity, a), steps.plus(identity, b), kRoi);
}

TEST(ShiftFit, FindsTheHomographyThatMovedTheBlocks) {
  const auto fit = fitShifts(shiftsOf(someMotion(), 0.0), kRoi, kSide);
  ASSERT_TRUE(fit);
  EXPECT_LT(cornersApart(fit->x, someMotion()), 0.15);
  EXPECT_GT(fit->significance, 10.0);
}

TEST(ShiftFit, NoiseIsNotSignificantAndAMotionBeyondItIs) {
  int significant = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    significant += fitShifts(shiftsOf(geometry::Vector8d::Zero(), 0.4, seed), kRoi, kSide)->significance > 1.5 ? 1 : 0;
    geometry::Vector8d shift = geometry::Vector8d::Zero();
    shift[0] = 2.0 / halfSize(kRoi);
    EXPECT_GT(fitShifts(shiftsOf(shift, 0.4, seed), kRoi, kSide)->significance, 10.0) << seed;
  }
  EXPECT_LE(significant, 8);
}

TEST(ShiftFit, AFewBlocksThatWentAstrayDoNotLeadIt) {
  std::vector<BlockShift> shifts = shiftsOf(someMotion(), 0.1);
  for (int k = 0; k < 5; ++k) shifts[7 * k].shift += Eigen::Vector2d(8.0, -6.0);
  EXPECT_LT(cornersApart(fitShifts(shifts, kRoi, kSide)->x, someMotion()), 1.0);
}

TEST(ShiftFit, BlocksThatAreNotConfidentSayNothing) {
  std::vector<BlockShift> shifts = shiftsOf(someMotion(), 0.0);
  for (std::size_t k = 0; k < shifts.size(); k += 2) {
    shifts[k].confident = false;
    shifts[k].shift = Eigen::Vector2d(50.0, 50.0);
  }
  EXPECT_LT(cornersApart(fitShifts(shifts, kRoi, kSide)->x, someMotion()), 0.25);
  EXPECT_EQ(confidentShifts(shifts), 18);
}

// The covariance holds what repeated measurement shows, but for what blocks that overlap have in common.
TEST(ShiftFit, TheCovarianceIsTheScatter) {
  constexpr int kTimes = 400;
  double squares = 0.0, claimed = 0.0;
  for (unsigned seed = 1; seed <= kTimes; ++seed) {
    const auto fit = fitShifts(shiftsOf(geometry::Vector8d::Zero(), 0.5, seed), kRoi, 15.0);
    squares += fit->x.head<2>().squaredNorm();
    claimed += fit->covariance.topLeftCorner<2, 2>().trace();
  }
  const double ratio = std::sqrt(squares / claimed);
  EXPECT_GT(ratio, 0.7);
  EXPECT_LT(ratio, 1.3);
}

TEST(ShiftFit, ShearAndPerspectiveAreBelievedOnlyAsFarAsTheyAreSeen) {
  geometry::Vector8d sheared = geometry::Vector8d::Zero();
  sheared[2] = 0.05;
  std::vector<BlockShift> shifts = shiftsOf(sheared, 0.0);
  const double all = fitShifts(shifts, kRoi, kSide)->x[2];
  for (std::size_t k = 0; k < shifts.size(); ++k) shifts[k].confident = k / 6 == 2;  // one row: it shifts, no more
  const double one_row = fitShifts(shifts, kRoi, kSide)->x[2];
  EXPECT_NEAR(all, 0.05, 0.005);
  EXPECT_LT(std::abs(one_row), 0.02);
}

TEST(ShiftFit, FewBlocksTellNothing) {
  std::vector<BlockShift> shifts = shiftsOf(someMotion(), 0.0);
  shifts.resize(4);
  EXPECT_FALSE(fitShifts(shifts, kRoi, kSide));
  EXPECT_FALSE(fitShifts({}, kRoi, kSide));
}

TEST(MedianShift, IsInPixelsOfTheImageAndNanWithoutAny) {
  geometry::Vector8d shift = geometry::Vector8d::Zero();
  shift[0] = 3.0 / halfSize(kRoi);
  const std::vector<BlockShift> shifts = shiftsOf(shift, 0.0);
  EXPECT_NEAR(medianShift(shifts, Eigen::Matrix3d::Identity()), 3.0, 1e-9);
  EXPECT_NEAR(medianShift(shifts, Eigen::Vector3d(2.0, 2.0, 1.0).asDiagonal()), 6.0, 1e-9);
  EXPECT_TRUE(std::isnan(medianShift({}, Eigen::Matrix3d::Identity())));
}

TEST(SpreadOfShifts, IsThatOfTheConfidentBlocksInTheDirectionOfTheLeast) {
  std::vector<BlockShift> shifts = shiftsOf(geometry::Vector8d::Zero(), 0.0);
  const auto keep = [&](auto which) {
    for (std::size_t k = 0; k < shifts.size(); ++k) shifts[k].confident = which(k / 6, k % 6);
    return spreadOfShifts(shifts, kRoi, kSide);
  };
  EXPECT_NEAR(keep([](std::size_t, std::size_t) { return true; }), 1.0, 0.02);
  EXPECT_NEAR(keep([](std::size_t, std::size_t column) { return column < 3; }), 0.5, 0.05);
  EXPECT_NEAR(keep([](std::size_t row, std::size_t) { return row >= 3; }), 0.5, 0.05);
  EXPECT_NEAR(keep([](std::size_t row, std::size_t) { return row == 2; }), 0.0, 1e-6);
  EXPECT_NEAR(keep([](std::size_t row, std::size_t column) { return row == column; }), 0.0, 0.05) << "a diagonal";
  EXPECT_EQ(keep([](std::size_t row, std::size_t column) { return row == 0 && column == 5; }), 0.0);
  EXPECT_EQ(keep([](std::size_t, std::size_t) { return false; }), 0.0);
}

double cornersBy(const Matrix8d& covariance) {
  return cornerError(Eigen::Matrix3d::Identity(), kRoi, covariance);
}

TEST(DeformationCovariance, IsZeroWhereBlocksAreOffByNoMoreThanTheyAreMeasured) {
  const auto shifts = shiftsOf(geometry::Vector8d::Zero(), 0.1);
  EXPECT_TRUE(deformationCovariance(shifts, 0.15, kRoi).isZero());
  EXPECT_TRUE(deformationCovariance(shifts, std::nan(""), kRoi).isZero());
  EXPECT_TRUE(deformationCovariance({}, 2.0, kRoi).isZero());
}

TEST(DeformationCovariance, GrowsWithWhatBlocksAreOffBy) {
  const auto shifts = shiftsOf(geometry::Vector8d::Zero(), 0.1);
  const double little = cornersBy(deformationCovariance(shifts, 0.5, kRoi));
  const double much = cornersBy(deformationCovariance(shifts, 1.5, kRoi));
  EXPECT_GT(little, 0.2);
  EXPECT_GT(much, 2.0 * little);
}

TEST(DeformationCovariance, IsLargerFarFromTheBlocksThatAreFound) {
  auto shifts = shiftsOf(geometry::Vector8d::Zero(), 0.1);
  const double all = cornersBy(deformationCovariance(shifts, 0.5, kRoi));
  for (BlockShift& s : shifts) s.confident = s.centre.x() < kRoi.x + 0.5 * kRoi.width;
  const Matrix8d half = deformationCovariance(shifts, 0.5, kRoi);
  EXPECT_GT(cornersBy(half), 1.5 * all);
  EXPECT_LT(centreError(Eigen::Matrix3d::Identity(), kRoi, half), cornersBy(half));
}

// A fit to few pieces follows most of what each of them deforms by, so that little of it is left at them.
TEST(DeformationCovariance, CountsWhatTheFitHasTakenUp) {
  const auto shifts = shiftsOf(geometry::Vector8d::Zero(), 0.1);
  const auto ofEvery = [&](int step) {
    auto some = shifts;
    for (std::size_t k = 0; k < some.size(); ++k) some[k].confident = k % step == 0;
    return cornersBy(deformationCovariance(some, 0.5, kRoi));
  };
  EXPECT_GT(ofEvery(4), 2.2 * ofEvery(1));  // by their number alone it would be twice
}

TEST(DeformationMemory, KeepsWhatWasSeenUntilEnoughIsSeenAgain) {
  DeformationMemory memory;
  Matrix8d covariance = Matrix8d::Identity();
  memory.complete(kDeformationShifts - 1, covariance);
  EXPECT_TRUE(covariance.isZero());  // there was none before
  covariance = 2.0 * Matrix8d::Identity();
  memory.complete(kDeformationShifts, covariance);
  EXPECT_TRUE(covariance.isApprox(2.0 * Matrix8d::Identity()));
  covariance.setZero();
  memory.complete(0, covariance);
  EXPECT_TRUE(covariance.isApprox(2.0 * Matrix8d::Identity()));
  covariance.setZero();
  memory.complete(kDeformationShifts, covariance);  // a plane that does not deform is seen
  EXPECT_TRUE(covariance.isZero());
}

}  // namespace
}  // namespace laparoscope_servo::tracking
