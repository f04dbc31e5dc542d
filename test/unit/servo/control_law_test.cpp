#include "laparoscope_servo/servo/control_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "laparoscope_servo/servo/insertion_point.h"

namespace laparoscope_servo::servo {
namespace {

using geometry::Rectangle;

const geometry::PinholeCamera kCamera{400.0, 400.0, 319.5, 239.5};
const Rectangle kRoi{270.0, 190.0, 100.0, 100.0};
const double kD2 = 0.1;
const double kZ = 0.08;

// The loop in continuous time: the scope stands where it is after moving from the reference pose, before a plane.
class Loop {
 public:
  Loop(const Eigen::Vector3d& normal, double depth, double d2) : normal_(normal), depth_(depth), d2_(d2) {}

  void move(const ScopeVelocity& velocity, double dt) {
    const double middle = d2_ + 0.5 * dt * velocity.insertion;
    reference_T_camera_ = reference_T_camera_ * geometry::se3Exp(dt * cameraTwist(velocity, middle));
    d2_ += dt * velocity.insertion;
  }

  // An offset from the reference pose: turned about the insertion point, then pushed in.
  void offset(const ScopeVelocity& displacement) {
    for (int k = 0; k < 100; ++k)
      move({displacement.pan, displacement.tilt, displacement.spin, displacement.insertion}, 0.01);
  }

  Eigen::Matrix3d homography() const { return geometry::fromPlane(reference_T_camera_.inverse(), normal_, depth_); }
  TaskError error() const { return taskError(homography(), kRoi, kCamera); }
  double d2() const { return d2_; }

  bool visible() const {
    const geometry::Quadrilateral corners =
        geometry::apply(geometry::pixelsFromNormalised(homography(), kCamera), kRoi.corners());
    if (!geometry::isConvex(corners)) return false;
    for (const Eigen::Vector2d& corner : corners) {
      if (!(corner.x() >= 0.0 && corner.x() <= 639.0 && corner.y() >= 0.0 && corner.y() <= 479.0)) return false;
    }
    return true;
  }

 private:
  Eigen::Vector3d normal_;
  double depth_;
  double d2_;
  Eigen::Isometry3d reference_T_camera_ = Eigen::Isometry3d::Identity();
};

double sizeOf(const TaskError& error) {
  return std::max({std::abs(error.x - error.desired_x), std::abs(error.y - error.desired_y), std::abs(error.log_depth),
                   std::abs(error.alpha)});
}

TEST(PaperLaw, IsZeroAtTheReference) {
  const Loop loop(Eigen::Vector3d::UnitZ(), kZ, kD2);
  EXPECT_NEAR(PaperLaw(PaperGains()).velocity(loop.error(), kD2).vector().norm(), 0.0, 1e-15);
}

// Each motion alone is answered by its opposite: the sign that eq. (7) leaves open.
TEST(PaperLaw, DrivesEachMotionBack) {
  for (int axis = 0; axis < 4; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Eigen::Vector4d displacement = Eigen::Vector4d::Zero();
      displacement[axis] = sign * (axis == 3 ? 0.005 : 0.05);
      Loop loop(Eigen::Vector3d::UnitZ(), kZ, kD2);
      loop.offset(ScopeVelocity::fromVector(displacement));
      const Eigen::Vector4d answer = PaperLaw(PaperGains()).velocity(loop.error(), loop.d2()).vector();
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
    Loop loop(Eigen::Vector3d::UnitZ(), kZ, kD2);
    loop.offset(ScopeVelocity::fromVector(displacement));
    const Eigen::Vector4d answer = PaperLaw(gains).velocity(loop.error(), loop.d2()).vector();
    EXPECT_NEAR(-answer[axis] / displacement[axis], rates[axis], 2e-3) << "axis " << axis;
  }
}

// The gains of pan and tilt hold the 1/d2 of eq. (11).
TEST(PaperLaw, DoesNotDependOnD2) {
  Loop loop(Eigen::Vector3d::UnitZ(), kZ, kD2);
  loop.offset({0.1, -0.1, 0.2, 0.01});
  const Eigen::Vector4d expected = PaperLaw(PaperGains()).velocity(loop.error(), 0.1).vector();
  for (const double d2 : {0.02, 0.05, 0.2}) {
    EXPECT_NEAR((PaperLaw(PaperGains()).velocity(loop.error(), d2).vector() - expected).norm(), 0.0, 1e-15);
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
    Loop loop(normal, depth, d2);
    loop.offset({0.25 * uniform(random), 0.25 * uniform(random), 0.7 * uniform(random), 0.3 * d2 * uniform(random)});
    if (!loop.visible()) continue;
    ++starts;
    const double before = sizeOf(loop.error());
    for (int k = 0; k < 3000; ++k) loop.move(law.velocity(loop.error(), loop.d2()), 0.04);
    EXPECT_LT(sizeOf(loop.error()), 1e-3) << "start " << starts << ", from " << before;
  }
}

}  // namespace
}  // namespace laparoscope_servo::servo
