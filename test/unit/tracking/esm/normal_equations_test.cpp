#include "tracking/esm/normal_equations.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <random>
#include <vector>

#include "laparoscope_servo/geometry/sl3.h"

namespace laparoscope_servo::tracking {
namespace {

// Convention: the row of J is the derivative of I(G exp(A(x)) p) at x = 0 for G = I, by the chain rule through the
// point.
TEST(EsmJacobian, IsTheDerivativeOfTheWarpedPoint) {
  const double gx = 1.7, gy = -0.6;
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.8, -0.5), Eigen::Vector2d(-1.0, 1.0)}) {
    const Eigen::Matrix<double, 1, 8> row = esmJacobianRow(gx, gy, p.x(), p.y());
    for (int k = 0; k < 8; ++k) {
      const double h = 1e-6;
      geometry::Vector8d x = geometry::Vector8d::Zero();
      x[k] = h;
      const Eigen::Vector3d forward = geometry::sl3Exp(x) * p.homogeneous();
      const Eigen::Vector3d backward = geometry::sl3Exp(-x) * p.homogeneous();
      const Eigen::Vector2d slope = (forward.hnormalized() - backward.hnormalized()) / (2.0 * h);
      EXPECT_NEAR(row[k], gx * slope.x() + gy * slope.y(), 1e-8) << "x_" << k + 1;
    }
  }
}

TEST(TemplateCoordinates, HaveTheirOriginInTheCentreAndHalfTheLargerSideForUnit) {
  const geometry::Rectangle roi = {100, 80, 60, 40};
  EXPECT_EQ(halfSize(roi), 30.0);
  const Eigen::Matrix3d n = templateFromPixels(roi);
  EXPECT_LT(geometry::apply(n, roi.centre()).norm(), 1e-12);
  const Eigen::Vector2d beside = roi.centre() + Eigen::Vector2d(30.0, -15.0);
  EXPECT_TRUE(geometry::apply(n, beside).isApprox(Eigen::Vector2d(1.0, -0.5)));
}

constexpr float kScale = 2.5f;  // of the gradients in cells: normalised units per cell unit

struct Pixels {
  int width = 19;
  int height = 11;
  std::vector<float> gx, gy, residual, intensity, weight;
  double u(int i) const { return -0.9 + 0.1 * i; }
  double v(int j) const { return -0.7 + 0.1 * j; }
};

Pixels randomPixels(unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  Pixels p;
  for (int k = 0; k < p.width * p.height; ++k) {
    p.gx.push_back(10.0f * normal(generator));
    p.gy.push_back(10.0f * normal(generator));
    p.residual.push_back(3.0f * normal(generator));
    p.intensity.push_back(100.0f + 20.0f * normal(generator));
    p.weight.push_back(k % 5 == 0 ? 0.0f : uniform(generator));
  }
  return p;
}

// Cells of one pixel: the monomials are exact.
void addAll(const Pixels& p, int row_begin, int row_end, NormalEquations& equations) {
  for (int j = row_begin; j < row_end; ++j) {
    for (int i = 0; i < p.width; ++i) {
      const std::size_t k = static_cast<std::size_t>(j) * p.width + i;
      const float x = p.gx[k] / kScale, y = p.gy[k] / kScale, r = p.residual[k], m = p.intensity[k], w = p.weight[k];
      equations.addCell({w * x * x, w * x * y, w * y * y, w * x * r, w * y * r, w * x, w * y, w * x * m, w * y * m, w,
                         w * r, w * m, w * m * m, w * m * r},
                        p.u(i), p.v(j));
    }
  }
  equations.endBlock();
}

// The full system: 8 motions, gain, and a bias for each of two blocks of rows, with no elimination.
struct Dense {
  Eigen::MatrixXd j;
  Eigen::VectorXd w, r;
};

Dense dense(const Pixels& p, int split) {
  const int n = p.width * p.height;
  Dense d{Eigen::MatrixXd::Zero(n, 11), Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (int k = 0; k < n; ++k) {
    const int row = k / p.width;
    d.j.row(k).head<8>() = esmJacobianRow(p.gx[k], p.gy[k], p.u(k % p.width), p.v(row));
    d.j(k, 8) = p.intensity[k];
    d.j(k, row < split ? 9 : 10) = 1.0;
    d.w[k] = p.weight[k];
    d.r[k] = p.residual[k];
  }
  return d;
}

double relative(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).norm() / b.norm();
}

TEST(NormalEquations, MomentsGiveTheSumOverPixels) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Pixels p = randomPixels(seed);
    const Dense d = dense(p, p.height);  // one block: column 10 is empty
    NormalEquations equations;
    equations.reset(Light::kGlobal, kScale);
    addAll(p, 0, p.height, equations);
    const Eigen::MatrixXd j = d.j.leftCols<10>();
    EXPECT_LT(relative(equations.matrix(), j.transpose() * d.w.asDiagonal() * j), 1e-6);
    EXPECT_LT(relative(equations.vector(), j.transpose() * d.w.asDiagonal() * d.r), 1e-5);
  }
}

TEST(NormalEquations, WithoutLightOnlyTheMotionIsLeft) {
  const Pixels p = randomPixels(7);
  const Dense d = dense(p, p.height);
  NormalEquations equations;
  equations.reset(Light::kConstant, kScale);
  addAll(p, 0, p.height, equations);
  Matrix10d expected = Matrix10d::Identity();
  expected.topLeftCorner<8, 8>() = d.j.leftCols<8>().transpose() * d.w.asDiagonal() * d.j.leftCols<8>();
  EXPECT_LT(relative(equations.matrix(), expected), 1e-6);
  EXPECT_EQ(equations.vector().tail<2>().norm(), 0.0);
}

TEST(NormalEquations, EliminatingTheBlocksBiasesGivesTheFullSystemsSolution) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Pixels p = randomPixels(seed);
    const int split = 4;
    const Dense d = dense(p, split);
    const Eigen::VectorXd full =
        -(d.j.transpose() * d.w.asDiagonal() * d.j).ldlt().solve(d.j.transpose() * d.w.asDiagonal() * d.r);

    NormalEquations equations;
    equations.reset(Light::kLocal, kScale);
    std::vector<double> bias;
    std::vector<Vector10d> jacobian;
    std::vector<double> weight, residual;
    for (const auto& [begin, end] : {std::pair(0, split), std::pair(split, p.height)}) {
      addAll(p, begin, end, equations);
      jacobian.push_back(equations.blockJacobian());
      weight.push_back(equations.blockWeight());
      residual.push_back(equations.blockResidual());
    }
    const Vector10d x = -equations.matrix().ldlt().solve(equations.vector());
    EXPECT_LT(relative(x.head<9>(), full.head<9>()), 1e-4);
    EXPECT_EQ(x[9], 0.0);
    for (int block = 0; block < 2; ++block) {
      EXPECT_NEAR(-(residual[block] + jacobian[block].dot(x)) / weight[block], full[9 + block], 1e-3);
    }
  }
}

TEST(NormalEquations, ABlockWithoutWeightAddsNothing) {
  Pixels p = randomPixels(3);
  for (Light light : {Light::kConstant, Light::kGlobal, Light::kLocal}) {
    NormalEquations once, twice;
    once.reset(light, kScale);
    twice.reset(light, kScale);
    addAll(p, 0, 5, once);
    addAll(p, 0, 5, twice);
    Pixels nothing = p;
    std::fill(nothing.weight.begin(), nothing.weight.end(), 0.0f);
    addAll(nothing, 5, 11, twice);
    EXPECT_TRUE(twice.matrix().allFinite());
    EXPECT_EQ((once.matrix() - twice.matrix()).norm(), 0.0);
    EXPECT_EQ((once.vector() - twice.vector()).norm(), 0.0);
  }
}

TEST(NormalEquations, ResetStartsAfresh) {
  const Pixels p = randomPixels(9);
  NormalEquations used, fresh;
  used.reset(Light::kGlobal, kScale);
  addAll(p, 0, 11, used);
  used.reset(Light::kLocal, kScale);
  fresh.reset(Light::kLocal, kScale);
  addAll(p, 0, 6, used);
  addAll(p, 0, 6, fresh);
  EXPECT_EQ((used.matrix() - fresh.matrix()).norm(), 0.0);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
