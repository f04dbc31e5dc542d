// STABILISE in the closed loop: what it promises, and that a wrong picture stops it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "laparoscope_servo/closed_loop/servo_runs.h"
#include "laparoscope_servo/closed_loop/servo_simulation.h"
#include "unit/closed_loop/wrong_pictures.h"

namespace laparoscope_servo::closed_loop {
namespace {

constexpr double kDegree = M_PI / 180.0;

SimulationConfig stabilising() {
  SimulationConfig config;
  config.task = "STABILISE";
  config.start = {0.12, 0.1, 0.0, 0.0};
  return config;
}

RunSummary run(const SimulationConfig& config, unsigned seed, double duration, double rest_after) {
  RunBounds bounds;
  bounds.rest_after = rest_after;
  return summariseRun(simulate(ControllerSetup(), config, seed, duration), config, bounds);
}

// The tissue breathes by 37 px, instruments cross, the robot is late by 160 ms.
TEST(StabiliseSimulation, KeepsTheViewOfBreathingTissue) {
  SimulationConfig config = stabilising();
  config.patient.breathing.second_harmonic = 0.3;
  config.patient.breathing.tissue = {0.0, 0.0074, 0.0};
  config.crossing = {6.0, 2.0, 0.5, 4.0};
  const RunSummary summary = run(config, 1, 120.0, 80.0);
  EXPECT_LT(summary.centre_rms, 1.0);  // px
  EXPECT_EQ(summary.final_state, servo::ControllerState::kServo);
  EXPECT_LT(summary.max_commanded_lateral_speed, 1e-12);
}

// Pushed away by hand, also out of a view that shows the region of interest: it comes back, and rests.
TEST(StabiliseSimulation, ComesBackFromWhereItWasPushed) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SimulationConfig config = stabilising();
    config.start = {seed % 2 == 0 ? 0.15 : -0.15, seed < 3 ? 0.09 : -0.09, 0.0, 0.0};
    const auto samples = simulate(ControllerSetup(), config, seed, 20.0);
    const RunSummary summary = summariseRun(samples, config, RunBounds{});
    EXPECT_GT(summary.settled_centre, 0.0) << seed;
    EXPECT_LT(summary.settled_centre, 6.0) << seed;
    EXPECT_EQ(samples.back().moved[2], 0.0) << "no spin";
    EXPECT_EQ(samples.back().moved[3], 0.0) << "no insertion";
  }
}

// Three degrees, beside what goes along the line of a mirror: there the motion is as it should be.
TEST(StabiliseSimulation, AWrongPictureIsStopped) {
  const auto configOf = [](unsigned) { return stabilising(); };
  expectStopped(wrongPictures(), 5, 8.0, configOf, [](const RunSummary& summary) {
    EXPECT_LT(summary.turned_away, 3.0 * kDegree);
    EXPECT_EQ(summary.inserted, 0.0);
  });
}

TEST(StabiliseSimulation, KeepsOrientationAndDepthOnChoice) {
  SimulationConfig config = stabilising();
  config.start = {0.05, 0.05, 0.15, 0.01};
  ControllerSetup controller;
  controller.control.stabilise.spin = controller.control.stabilise.insertion = true;
  const RunSummary all = summariseRun(simulate(controller, config, 1, 20.0), config, RunBounds{});
  EXPECT_GT(all.settled, 0.0);
  controller.control.stabilise.insertion = false;
  const RunSummary spin = summariseRun(simulate(controller, config, 1, 20.0), config, RunBounds{});
  EXPECT_GT(spin.settled_orientation, 0.0);
  EXPECT_LT(spin.settled_scale, 0.0) << "the error that remains";
}

}  // namespace
}  // namespace laparoscope_servo::closed_loop
