#include "servo/law/paper_law.h"

#include <gtest/gtest.h>

#include <random>

#include "unit/servo/plane_loop.h"

namespace laparoscope_servo::servo {
namespace {

using test::kD2;
using test::kZ;
using test::PlaneLoop;
using test::sizeOf;
using test::straight;

TEST(PaperLaw, IsZeroAtTheReference) {
  const PlaneLoop loop(Eigen::Vector3d::UnitZ(), kZ, straight());
  EXPECT_NEAR(PaperLaw(PaperGains()).velocity(loop.error(), loop.scope()).sum().vector().norm(), 0.0, 1e-15);
}

// Each motion alone is answered by its opposite: the sign that eq. (7) leaves open.
TEST(PaperLaw, DrivesEachMotionBack) {
  for (int axis = 0; axis < 4; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Eigen::Vector4d displacement = Eigen::Vector4d::Zero();
      displacement[axis] = sign * (axis == 3 ? 0.005 : 0.05);
      PlaneLoop loop(Eigen::Vector3d::UnitZ(), kZ, straight());
      loop.offset(scope::Velocity::fromVector(displacement));
      const Eigen::Vector4d answer = PaperLaw(PaperGains()).velocity(loop.error(), loop.scope()).sum().vector();
      EXPECT_LT(answer[axis] * displacement[axis], 0.0) << "axis " << axis;
    }
  }
}

// Rates on the axis: k_p (1 + d2/Z*), k_t (1 + d2/Z*), 2 k_s, k_d/Z*.
TEST(PaperLaw, DecaysWithTheRatesOfTheLinearLoop) {
  const PaperGains gains;
  const double rates[] = {gains.pan * (1.0 + kD2 / kZ), gains.tilt * (1.0 + kD2 / kZ), 2.0 * gains.spin,
                          gains.insertion / kZ};
  for (int axis = 0; axis < 4; ++axis) {
    Eigen::Vector4d displacement = Eigen::Vector4d::Zero();
    displacement[axis] = 1e-4;
    PlaneLoop loop(Eigen::Vector3d::UnitZ(), kZ, straight());
    loop.offset(scope::Velocity::fromVector(displacement));
    const Eigen::Vector4d answer = PaperLaw(gains).velocity(loop.error(), loop.scope()).sum().vector();
    EXPECT_NEAR(-answer[axis] / displacement[axis], rates[axis], 2e-3) << "axis " << axis;
  }
}

// The gains of pan and tilt hold the 1/d2 of eq. (11).
TEST(PaperLaw, DoesNotDependOnD2) {
  PlaneLoop loop(Eigen::Vector3d::UnitZ(), kZ, straight());
  loop.offset({0.1, -0.1, 0.2, 0.01});
  const Eigen::Vector4d expected = PaperLaw(PaperGains()).velocity(loop.error(), straight(0.1)).sum().vector();
  for (const double d2 : {0.02, 0.05, 0.2}) {
    EXPECT_NEAR((PaperLaw(PaperGains()).velocity(loop.error(), straight(d2)).sum().vector() - expected).norm(), 0.0,
                1e-15);
  }
}

// From 200 random starts with the whole ROI in the image; also with d2 and Z* half and double of what the gains were
// made for.
TEST(PaperLaw, ConvergesFromRandomVisibleStarts) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const PaperLaw law{PaperGains()};
  int starts = 0;
  while (starts < 200) {
    const double d2 = kD2 * std::pow(2.0, uniform(random));
    const double depth = kZ * std::pow(2.0, uniform(random));
    const Eigen::Vector3d normal = Eigen::Vector3d(0.2 * uniform(random), 0.2 * uniform(random), 1.0).normalized();
    PlaneLoop loop(normal, depth, straight(d2));
    loop.offset({0.25 * uniform(random), 0.25 * uniform(random), 0.7 * uniform(random), 0.3 * d2 * uniform(random)});
    if (!loop.visible()) continue;
    ++starts;
    const double before = sizeOf(loop.error());
    for (int k = 0; k < 3000; ++k) loop.move(law.velocity(loop.error(), loop.scope()).sum(), 0.04);
    EXPECT_LT(sizeOf(loop.error()), 1e-3) << "start " << starts << ", from " << before;
  }
}

}  // namespace
}  // namespace laparoscope_servo::servo
