// POINTS in the closed loop: it converges though points are astray, and a wrong picture stops it.
#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <vector>

#include "laparoscope_servo/closed_loop/servo_runs.h"
#include "laparoscope_servo/closed_loop/servo_simulation.h"
#include "unit/closed_loop/wrong_pictures.h"

namespace laparoscope_servo::closed_loop {
namespace {

constexpr double kDegree = M_PI / 180.0;

SimulationConfig withPoints(double astray) {
  SimulationConfig config;
  config.task = "POINTS";
  config.points_astray = astray;
  config.start = {0.12, 0.08, 0.25, 0.015};
  return config;
}

TEST(PointsSimulation, ConvergesThoughThreeOfTenAreAstray) {
  for (const double astray : {0.0, 0.3}) {
    const SimulationConfig config = withPoints(astray);
    const auto samples = simulate(ControllerSetup(), config, 1, 20.0);
    for (const SimulationSample& s : samples) EXPECT_LT(s.commanded_lateral_speed, 1e-15);
    const SimulationSummary summary = summarise(samples, config);
    EXPECT_EQ(samples.back().state, servo::ControllerState::kServo);
    EXPECT_GE(summary.settling_time, 0.0) << astray;
    EXPECT_LT(summary.final_offset, 1.0) << astray;
    EXPECT_LT(std::abs(summary.final_alpha), 0.5 * kDegree) << astray;
  }
}

TEST(PointsSimulation, NothingMovesWhenMostAreAstray) {
  const SimulationConfig config = withPoints(0.8);
  for (const SimulationSample& s : simulate(ControllerSetup(), config, 1, 5.0)) {
    EXPECT_LT(s.moved.head<2>().norm(), 3.0 * kDegree) << "points that stand still in the image are at their goal";
  }
}

TEST(PointsSimulation, AWrongPictureIsStopped) {
  const auto configOf = [](unsigned) { return withPoints(0.0); };
  expectStopped(wrongPictures(), 5, 10.0, configOf, [](const RunSummary& summary) {
    EXPECT_LT(summary.turned_away, 3.0 * kDegree);
    EXPECT_LT(summary.inserted_away, 0.004);
  });
}

}  // namespace
}  // namespace laparoscope_servo::closed_loop
