#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/synthetic_tissue.h"
#include "tracking/esm/normal_equations.h"

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {30, 20, 60, 50};
constexpr double kGain = 0.9;
constexpr double kBias = 6.0;

class LevelEquationsTest : public ::testing::Test {
 protected:
  EsmLevel level_ = level(0);

  // The image is the reference, moved and noisy.
  static EsmLevel level(int l) {
    const cv::Mat scene = test::tissue(cv::Size(160, 140), 4);
    Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();
    shift.topRightCorner<2, 1>() << 0.7, -0.4;
    image::RegionPyramid reference, current;
    reference.build(scene, cv::Rect(0, 0, 160, 140), 2, image::kLuma);
    current.build(test::view(scene, shift, 1.0, 0.0, 2.0), cv::Rect(0, 0, 160, 140), 2, image::kLuma);
    EsmLevel result(reference, kRoi, l);
    const cv::Rect roi(30 >> l, 20 >> l, result.width, result.height);
    current.level(l)(roi).copyTo(result.planes[0].warped.view());
    result.planes[0].warped.extrapolate();
    for (double& bias : result.planes[0].bias) bias = kBias;
    for (int j = 0; j < result.height; ++j) {
      for (int i = 0; i < result.width; ++i) result.weight(j, i) = (i + 2 * j) % 7 == 0 ? 0.0f : 1.0f;
    }
    return result;
  }

  // Pixel by pixel, without cells.
  static void dense(const EsmLevel& level, double rejection, Matrix10d& matrix, Vector10d& vector) {
    const EsmPlane& p = level.planes[0];
    const Eigen::Matrix3d unit_T_patch = templateFromPixels(kRoi) * level.image_T_patch;
    const double unit = 0.5 * halfSize(kRoi) / level.scale;
    matrix.setZero();
    vector.setZero();
    for (int j = 0; j < level.height; ++j) {
      for (int i = 0; i < level.width; ++i) {
        const auto sum = [&](int row, int column) { return kGain * p.warped(row, column) + p.value(row, column); };
        const Eigen::Vector2d at = geometry::apply(unit_T_patch, Eigen::Vector2d(i, j));
        Vector10d row;
        row.head<8>() = esmJacobianRow(unit * (sum(j, i + 1) - sum(j, i - 1)) / 2.0,
                                       unit * (sum(j + 1, i) - sum(j - 1, i)) / 2.0, at.x(), at.y());
        row[8] = 0.5 * (p.warped(j, i) + p.value(j, i));
        row[9] = 1.0;
        const double residual = kGain * p.warped(j, i) + kBias - p.value(j, i);
        double weight = level.weight(j, i);
        if (rejection > 0.0) weight *= std::pow(std::max(0.0, 1.0 - std::pow(residual / rejection, 2)), 2);
        matrix += weight * row * row.transpose();
        vector += weight * residual * row;
      }
    }
  }
};

// Of correlations: the entries of a matrix with the units of its diagonal taken out.
double difference(const Matrix10d& a, const Matrix10d& b) {
  const Vector10d units = b.diagonal().cwiseSqrt().cwiseInverse();
  return (units.asDiagonal() * (a - b) * units.asDiagonal()).cwiseAbs().maxCoeff();
}

TEST_F(LevelEquationsTest, AreThoseOfThePixels) {
  for (const int l : {0, 1}) {
    const EsmLevel level = LevelEquationsTest::level(l);
    for (const double rejection : {0.0, 20.0}) {
      Matrix10d matrix;
      Vector10d vector;
      dense(level, rejection, matrix, vector);
      LevelEquations equations;
      equations.sum(level, kRoi, Light::kGlobal, kGain, rejection);
      EXPECT_LT(difference(equations.matrix(), matrix), 0.03) << l << ' ' << rejection;
      const Vector10d units = matrix.diagonal().cwiseSqrt();
      EXPECT_LT((equations.vector() - vector).cwiseQuotient(units).norm(), 0.03 * vector.cwiseQuotient(units).norm())
          << l << ' ' << rejection;
    }
  }
}

TEST_F(LevelEquationsTest, BlocksTogetherAreTheWhole) {
  LevelEquations equations;
  equations.sum(level_, kRoi, Light::kGlobal, kGain, 0.0);
  ASSERT_EQ(equations.blocks().size(), level_.planes[0].bias.size());
  ASSERT_GT(equations.blocks().size(), 1u);
  Vector10d score = Vector10d::Zero();
  double weight = 0.0;
  for (const LightBlockSums& sums : equations.blocks()) {
    score += sums.score;
    weight += sums.weight;
  }
  EXPECT_LT((score - equations.vector()).norm(), 1e-6 * score.norm());
  EXPECT_NEAR(weight, cv::sum(level_.weight.view())[0], 1e-3);
}

// In the order of the picture, whatever the blocks.
TEST_F(LevelEquationsTest, KeepsTheCells) {
  LevelEquations equations;
  equations.sum(level_, kRoi, Light::kGlobal, kGain, 0.0);
  const int columns = level_.weight.strips() * level_.cells_per_strip;
  const int width = image::Patch::kStrip / level_.cells_per_strip;
  const int rows = (level_.height + level_.cell_rows - 1) / level_.cell_rows;
  ASSERT_GE(static_cast<int>(equations.cells().size()), rows * columns);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      float weight = 0.0f;
      for (int j = row * level_.cell_rows; j < std::min((row + 1) * level_.cell_rows, level_.height); ++j) {
        for (int i = column * width; i < std::min((column + 1) * width, level_.width); ++i)
          weight += level_.weight(j, i);
      }
      ASSERT_EQ(equations.cells()[static_cast<std::size_t>(row * columns + column)].w, weight) << row << ", " << column;
    }
  }
}

TEST_F(LevelEquationsTest, EachBlockHasItsOwnBias) {
  LevelEquations equations;
  level_.planes[0].bias[1] += 4.0;
  equations.sum(level_, kRoi, Light::kGlobal, kGain, 0.0);
  const std::vector<LightBlockSums> shifted = equations.blocks();
  level_.planes[0].bias[1] -= 4.0;
  equations.sum(level_, kRoi, Light::kGlobal, kGain, 0.0);
  ASSERT_EQ(equations.blocks().size(), shifted.size());
  for (std::size_t k = 0; k < shifted.size(); ++k) {
    const LightBlockSums& plain = equations.blocks()[k];
    EXPECT_NEAR(shifted[k].residual, plain.residual + (k == 1 ? 4.0 * plain.weight : 0.0), 1e-2) << k;
  }
}

TEST_F(LevelEquationsTest, WhatIsRejectedAddsNothing) {
  LevelEquations equations;
  level_.planes[0].warped.view() += 500.0f;
  equations.sum(level_, kRoi, Light::kGlobal, kGain, 20.0);
  EXPECT_EQ(equations.vector().norm(), 0.0);
  for (const LightBlockSums& sums : equations.blocks()) EXPECT_EQ(sums.weight, 0.0);
}

TEST_F(LevelEquationsTest, ASumStartsAfresh) {
  LevelEquations used, fresh;
  used.sum(level(1), kRoi, Light::kLocal, 1.2, 10.0);
  used.sum(level_, kRoi, Light::kGlobal, kGain, 0.0);
  fresh.sum(level_, kRoi, Light::kGlobal, kGain, 0.0);
  EXPECT_EQ(used.matrix(), fresh.matrix());
  EXPECT_EQ(used.vector(), fresh.vector());
  EXPECT_EQ(used.blocks().size(), fresh.blocks().size());
}

}  // namespace
}  // namespace laparoscope_servo::tracking
