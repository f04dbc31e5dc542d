// FOLLOW in the closed loop: how far it lags, where the leash ends it, and that a wrong picture stops it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/closed_loop/servo_runs.h"
#include "laparoscope_servo/closed_loop/servo_simulation.h"
#include "unit/closed_loop/wrong_pictures.h"

namespace laparoscope_servo::closed_loop {
namespace {

constexpr double kDegree = M_PI / 180.0;

SimulationConfig following(double drift) {
  SimulationConfig config;
  config.task = "FOLLOW";
  config.start = {0.05, -0.03, 0.0, 0.0};
  config.patient.drift = {drift, 0.0, 0.0};
  return config;
}

double offset(const SimulationConfig& config, const SimulationSample& s) {
  return (Eigen::Vector2d(s.u, s.v) - config.camera.matrix().topRightCorner<2, 1>()).norm();
}

// 20 px/s.
TEST(FollowSimulation, AMovingObjectStaysInTheMiddle) {
  const SimulationConfig config = following(0.004);
  for (unsigned seed = 1; seed <= 3; ++seed) {
    double sum = 0.0, count = 0.0;
    for (const SimulationSample& s : simulate(ControllerSetup(), config, seed, 6.0)) {
      EXPECT_EQ(s.state, servo::ControllerState::kServo) << s.t;
      EXPECT_EQ(s.command.spin, 0.0);
      EXPECT_EQ(s.command.insertion, 0.0);
      EXPECT_LT(s.commanded_lateral_speed, 1e-15);
      if (s.t < 3.0) continue;
      sum += std::pow(offset(config, s), 2);
      count += 1.0;
    }
    EXPECT_LT(std::sqrt(sum / count), 5.0) << "px, seed " << seed;
  }
}

// One that goes on is not chased out of the workspace.
TEST(FollowSimulation, TheLeashEndsIt) {
  SimulationConfig config = following(0.004);
  config.poses = true;
  const auto samples = simulate(ControllerSetup(), config, 1, 20.0);
  EXPECT_EQ(samples.back().state, servo::ControllerState::kLost);
  const RunSummary summary = summariseRun(samples, config, RunBounds{});
  EXPECT_LT(summary.turned, 16.0 * kDegree);
}

TEST(FollowSimulation, AWrongPictureIsStopped) {
  const auto configOf = [](unsigned) {
    SimulationConfig config = following(0.0);
    config.start = {0.12, 0.08, 0.0, 0.0};
    return config;
  };
  expectStopped(wrongPicturesAndFreezing(), 5, 10.0, configOf, [](const RunSummary& summary) {
    EXPECT_LT(summary.turned_away, 3.0 * kDegree);
    EXPECT_EQ(summary.inserted, 0.0);
  });
}

}  // namespace
}  // namespace laparoscope_servo::closed_loop
