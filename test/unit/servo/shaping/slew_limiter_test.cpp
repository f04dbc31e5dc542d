#include "servo/shaping/slew_limiter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace laparoscope_servo::servo {
namespace {

const double kRounding = 1.0 + 1e-12;

Limits limits() {
  Limits l;
  l.velocity = {0.1, 0.08, 0.2, 0.02};
  l.acceleration = {0.5, 0.4, 1.0, 0.1};
  return l;
}

double angleBetween(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
  return std::acos(std::min(1.0, a.dot(b) / a.norm() / b.norm()));
}

TEST(SlewLimiter, LeavesWhatIsWithinTheLimits) {
  SlewLimiter limiter(limits());
  const scope::Velocity wanted{0.05, -0.04, 0.1, 0.01};
  EXPECT_EQ(limiter.apply(wanted, 1.0).vector(), wanted.vector());
  EXPECT_EQ(limiter.apply(scope::Velocity(), 1.0).vector(), Eigen::Vector4d::Zero());
}

TEST(SlewLimiter, NeverExceedsTheLimits) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const Eigen::Vector4d velocity = limits().velocity.vector();
  const Eigen::Vector4d acceleration = limits().acceleration.vector();
  SlewLimiter limiter(limits());
  Eigen::Vector4d last = Eigen::Vector4d::Zero();
  for (int k = 0; k < 20000; ++k) {
    const double size = std::pow(10.0, 4.0 * uniform(random) - 3.0);
    const scope::Velocity wanted{size * normal(random), size * normal(random), size * normal(random),
                                 0.2 * size * normal(random)};
    const double dt = k % 10 == 0 ? 0.0 : 0.05 * uniform(random);
    const scope::Velocity other{normal(random), -size * normal(random), 0.1 * normal(random), 0.01 * normal(random)};
    const Eigen::Vector4d command =
        (k % 2 == 0 ? limiter.apply(wanted, dt) : limiter.apply({wanted, other}, dt)).vector();
    for (int i = 0; i < 4; ++i) {
      EXPECT_LE(std::abs(command[i]), velocity[i] * kRounding);
      EXPECT_LE(std::abs(command[i] - last[i]), dt * acceleration[i] * kRounding + 1e-15);
    }
    last = command;
  }
}

TEST(SlewLimiter, KeepsTheDirection) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 200; ++k) {
    const scope::Velocity wanted{normal(random), normal(random), normal(random), normal(random)};
    SlewLimiter limiter(limits());
    for (int step = 0; step < 30; ++step) {
      const Eigen::Vector4d command = limiter.apply(wanted, 0.02).vector();
      EXPECT_LT(angleBetween(command, wanted.vector()), 1e-7);
    }
  }
}

TEST(SlewLimiter, ReachesTheScaledTargetStraight) {
  SlewLimiter limiter(limits());
  const scope::Velocity first{0.1, 0.0, 0.0, 0.0};
  for (int step = 0; step < 30; ++step) limiter.apply(first, 0.02);
  const scope::Velocity second{0.0, 0.16, 0.0, 0.0};  // twice its limit
  const Eigen::Vector4d target(0.0, 0.08, 0.0, 0.0);
  Eigen::Vector4d last = first.vector();
  for (int step = 0; step < 30; ++step) {
    const Eigen::Vector4d command = limiter.apply(second, 0.02).vector();
    if (command != target) {
      EXPECT_LT(angleBetween(command - last, target - first.vector()), 1e-6);
    }
    last = command;
  }
  EXPECT_EQ(last, target);
}

// The first parts have the room first, but none has to wait for another to finish.
TEST(SlewLimiter, PartsKeepTheirDirectionsAndShareTheRoom) {
  const scope::Velocity turning{0.0, 0.0, 1.0, 0.0}, centring{0.2, 0.1, 0.0, 0.004};
  SlewLimiter limiter(limits());
  const Eigen::Vector4d command = limiter.apply({turning, centring}, 10.0).vector();
  EXPECT_NEAR(command[2], 0.2, 1e-12);  // its limit
  EXPECT_NEAR(command[0], 0.1, 1e-12);  // its limit
  EXPECT_NEAR(command[1] / command[0], 0.5, 1e-12);
  EXPECT_NEAR(command[3] / command[0], 0.02, 1e-12);
  // Both want the same axis: neither gets nothing.
  limiter.reset();
  const Eigen::Vector4d both =
      limiter.apply({scope::Velocity{0.0, 0.0, 1.0, 0.0}, scope::Velocity{0.05, 0.0, 1.0, 0.0}}, 10.0).vector();
  EXPECT_NEAR(both[2], 0.2, 1e-12);
  EXPECT_GT(both[0], 0.004);
}

TEST(SlewLimiter, PartsWithinTheLimitsAddUp) {
  SlewLimiter limiter(limits());
  const Eigen::Vector4d command =
      limiter.apply({scope::Velocity{0.05, 0, 0, 0}, scope::Velocity{-0.02, 0.01, 0, 0}}, 10.0).vector();
  EXPECT_NEAR((command - Eigen::Vector4d(0.03, 0.01, 0.0, 0.0)).norm(), 0.0, 1e-15);
}

TEST(SlewLimiter, DoesNotMoveWithoutTime) {
  SlewLimiter limiter(limits());
  EXPECT_EQ(limiter.apply({1.0, 1.0, 1.0, 1.0}, 0.0).vector(), Eigen::Vector4d::Zero());
}

TEST(SlewLimiter, ResetIsAStopAtOnce) {
  SlewLimiter limiter(limits());
  limiter.apply({0.1, 0.0, 0.0, 0.0}, 1.0);
  limiter.reset();
  EXPECT_EQ(limiter.apply(scope::Velocity(), 0.0).vector(), Eigen::Vector4d::Zero());
}

// Not made one of the limits: what is wrong must come out so.
TEST(SlewLimiter, WhatIsNoNumberStaysNone) {
  for (int k = 0; k < 4; ++k) {
    SlewLimiter limiter(limits());
    Eigen::Vector4d wanted = limits().velocity.vector();
    wanted[k] = std::nan("");
    EXPECT_FALSE(limiter.apply(scope::Velocity::fromVector(wanted), 0.02).isFinite()) << k;
  }
}

TEST(SlewLimiter, ALimitThatIsNoNumberAllowsNothing) {
  SlewLimiter limiter(limits());
  EXPECT_EQ(limiter.apply({scope::Velocity{0.05, 0.01, 0.0, 0.0}}, 10.0, std::nan("")).vector(),
            Eigen::Vector4d::Zero());
  limiter.reset();
  EXPECT_EQ(limiter.apply({scope::Velocity{0.05, 0.01, 0.0, 0.0}}, std::nan("")).vector(), Eigen::Vector4d::Zero());
}

}  // namespace
}  // namespace laparoscope_servo::servo
