#include <gtest/gtest.h>

#include "tracking/esm/normal_equations.h"

namespace laparoscope_servo::tracking {
namespace {

using Matrix = Factors<3>::Matrix;

TEST(Factors, SolvesWhateverTheUnitsOfTheUnknowns) {
  Matrix correlation;
  correlation << 1.0, 0.4, -0.2, 0.4, 1.0, 0.3, -0.2, 0.3, 1.0;
  const Eigen::Vector3d x(0.3, -2.0, 1.5);
  for (const double unit : {1e-6, 1.0, 1e6}) {
    const Eigen::Vector3d units(1.0, unit, 1.0 / unit);
    const Matrix a = units.asDiagonal() * correlation * units.asDiagonal();
    const Eigen::Vector3d scaled = units.cwiseInverse().cwiseProduct(x);
    const Factors<3> factors(a);
    EXPECT_TRUE(units.cwiseProduct(factors.solve(a * scaled)).isApprox(x, 1e-9)) << unit;
    EXPECT_NEAR(factors.conditioning(), Factors<3>(correlation).conditioning(), 1e-9) << unit;
  }
}

TEST(Factors, ConditioningGoesFromSingularToDiagonal) {
  EXPECT_NEAR(Factors<3>(Eigen::Vector3d(1e-3, 1.0, 1e5).asDiagonal().toDenseMatrix()).conditioning(), 1.0, 1e-12);
  const Eigen::Vector3d v(1.0, 2.0, 3.0);
  EXPECT_LT(Factors<3>(v * v.transpose()).conditioning(), 1e-12);
  EXPECT_LT(Factors<3>(Matrix::Zero()).conditioning(), 1e-12);
  Matrix without = Matrix::Identity();
  without(1, 1) = 0.0;
  EXPECT_LT(Factors<3>(without).conditioning(), 1e-12);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
