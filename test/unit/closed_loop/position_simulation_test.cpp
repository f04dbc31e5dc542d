// POSITION in the closed loop: it converges from far before slanted tissue, and a wrong picture stops it.
#include <gtest/gtest.h>

#include <cmath>

#include "laparoscope_servo/closed_loop/servo_runs.h"
#include "laparoscope_servo/closed_loop/servo_simulation.h"
#include "unit/closed_loop/wrong_pictures.h"

namespace laparoscope_servo::closed_loop {
namespace {

constexpr double kDegree = M_PI / 180.0;

SimulationConfig positioning() {
  SimulationConfig config;
  config.task = "POSITION";
  config.tissue_slant_x = 0.35;
  return config;
}

// As the scenario of that name.
TEST(PositionSimulation, ConvergesFromLargeStarts) {
  SimulationConfig config = positioning();
  config.width = 1280.0;
  config.height = 960.0;
  config.camera = {400.0, 400.0, 639.5, 479.5};
  config.roi = {590.0, 430.0, 100.0, 100.0};
  for (const double side : {-1.0, 1.0}) {
    config.start = {0.2 * side, -0.2, 0.6, 0.015 * side};
    const auto samples = simulate(ControllerSetup(), config, 1, 30.0);
    for (const SimulationSample& s : samples) EXPECT_LT(s.commanded_lateral_speed, 1e-15);
    const SimulationSummary summary = summarise(samples, config);
    EXPECT_EQ(samples.back().state, servo::ControllerState::kServo);
    EXPECT_GE(summary.settling_time, 0.0) << side;
    EXPECT_LT(summary.final_offset, 1.0) << side;
    EXPECT_LT(std::abs(summary.final_scale_error), 0.01) << side;
    EXPECT_LT(std::abs(summary.final_alpha), 0.5 * kDegree) << side;
  }
}

TEST(PositionSimulation, AWrongPictureIsStopped) {
  const auto configOf = [](unsigned) {
    SimulationConfig config = positioning();
    config.start = {0.12, 0.08, 0.1, 0.0};
    return config;
  };
  expectStopped(wrongPictures(), 5, 10.0, configOf, [](const RunSummary& summary) {
    EXPECT_LT(summary.turned_away, 3.0 * kDegree);
    EXPECT_LT(summary.inserted_away, 0.004);
  });
}

}  // namespace
}  // namespace laparoscope_servo::closed_loop
