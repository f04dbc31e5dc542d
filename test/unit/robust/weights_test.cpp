#include "laparoscope_servo/robust/weights.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::robust {
namespace {

// psi(u) of eq. (12), as the derivative of Tukey's rho by differences.
double rho(double u) {
  const double t = std::min(1.0, u * u / (kTukey * kTukey));
  return kTukey * kTukey / 6.0 * (1.0 - std::pow(1.0 - t, 3.0));
}

TEST(Weights, tukeyIsTheDerivativeOfRhoOverTheResidual) {
  constexpr double kStep = 1e-5;
  for (const double u : {-4.5, -2.0, -0.1, 0.3, 1.0, 3.0, 4.6, 4.7, 9.0}) {
    const double psi = (rho(u + kStep) - rho(u - kStep)) / (2.0 * kStep);
    EXPECT_NEAR(tukeyWeight(u), psi / u, 1e-6) << u;
  }
}

TEST(Weights, areOneWithoutAResidualAndKeepTheirOrder) {
  EXPECT_EQ(tukeyWeight(0.0), 1.0);
  EXPECT_EQ(huberWeight(0.0), 1.0);
  EXPECT_EQ(huberWeight(-kHuber), 1.0);
  for (double u = 0.1; u < 10.0; u += 0.1) {
    EXPECT_LE(tukeyWeight(u), tukeyWeight(u - 0.1));
    EXPECT_LE(huberWeight(u), huberWeight(u - 0.1));
    EXPECT_EQ(tukeyWeight(u), tukeyWeight(-u));
    EXPECT_EQ(huberWeight(u), huberWeight(-u));
  }
}

TEST(Weights, tukeyForgetsWhatIsFarHuberDoesNot) {
  EXPECT_EQ(tukeyWeight(kTukey), 0.0);
  EXPECT_EQ(tukeyWeight(1e300), 0.0);
  EXPECT_DOUBLE_EQ(huberWeight(10.0), kHuber / 10.0);
}

TEST(Weights, sayWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(tukeyWeight(nan)));
  EXPECT_TRUE(std::isnan(huberWeight(nan)));
}

}  // namespace
}  // namespace laparoscope_servo::robust
