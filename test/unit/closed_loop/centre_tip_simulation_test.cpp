// CENTRE_TIP in the closed loop: what it promises, and that a wrong picture stops it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/closed_loop/servo_runs.h"
#include "laparoscope_servo/closed_loop/servo_simulation.h"
#include "unit/closed_loop/wrong_pictures.h"

namespace laparoscope_servo::closed_loop {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kZone = 60.0;  // px: centre_tip/zone at a focal length of 400 px

SimulationConfig centring() {
  SimulationConfig config;
  config.task = "CENTRE_TIP";
  config.start = {0.12, 0.08, 0.0, 0.0};
  return config;
}

double offset(const SimulationConfig& config, const SimulationSample& s) {
  return (Eigen::Vector2d(s.u, s.v) - config.roi.centre()).norm();
}

// A hand takes the tip by up to 100 px to another place, every 10 s, and holds it.
TEST(CentreTipSimulation, TheTipIsBackInItsZoneAndNothingMovesThere) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    SimulationConfig config = centring();
    config.patient.pull.distance = 0.02;
    double outside_since = -1.0;
    bool moved = false;
    for (const SimulationSample& s : simulate(ControllerSetup(), config, seed, 60.0)) {
      const double off = offset(config, s);
      if (off <= kZone + 5.0 || s.state != servo::ControllerState::kServo) outside_since = s.t;
      EXPECT_LT(s.t - outside_since, 4.0) << "seed " << seed << ", " << s.t << " s";
      const bool moves = s.command.vector() != Eigen::Vector4d::Zero();
      moved |= moves;
      EXPECT_FALSE(moves && off < 30.0) << "seed " << seed << ", " << s.t << " s";
      EXPECT_EQ(s.command.spin, 0.0);
      EXPECT_EQ(s.command.insertion, 0.0);
    }
    EXPECT_TRUE(moved);
  }
}

TEST(CentreTipSimulation, AnInstrumentThatLeavesIsNotFollowed) {
  SimulationConfig config = centring();
  config.start = {0.0, 0.0, 0.0, 0.0};
  config.patient.drift = {0.03, 0.0, 0.0};  // 150 px/s, out of the image
  const auto samples = simulate(ControllerSetup(), config, 1, 6.0);
  for (const SimulationSample& s : samples) EXPECT_EQ(s.command.vector().norm(), 0.0) << s.t;
  EXPECT_EQ(samples.back().state, servo::ControllerState::kLost);
}

TEST(CentreTipSimulation, AWrongPictureIsStopped) {
  const auto configOf = [](unsigned) { return centring(); };
  expectStopped(wrongPicturesAndFreezing(), 5, 10.0, configOf, [](const RunSummary& summary) {
    EXPECT_LT(summary.turned_away, 3.0 * kDegree);
    EXPECT_EQ(summary.inserted, 0.0);
  });
}

}  // namespace
}  // namespace laparoscope_servo::closed_loop
