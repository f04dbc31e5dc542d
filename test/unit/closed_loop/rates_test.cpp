// Times are in seconds, not in images or steps: a camera of another rate, or a controller of another, makes no other
// loop.
#include <gtest/gtest.h>

#include <cmath>

#include "laparoscope_servo/closed_loop/servo_runs.h"

namespace laparoscope_servo::closed_loop {
namespace {

struct Rates {
  double camera = 25.0;   // Hz
  double control = 50.0;  // Hz
};

constexpr Rates kAll[] = {{12.5, 50.0}, {25.0, 50.0}, {60.0, 50.0}, {25.0, 25.0}, {25.0, 100.0}};

RunSummary run(const Rates& rates, const SimulationConfig& scene, double duration, double rest_after) {
  ControllerSetup controller;
  controller.rate = rates.control;
  SimulationConfig config = scene;
  config.frame_rate = rates.camera;
  RunBounds bounds;
  bounds.rest_after = rest_after;
  return summariseRun(simulate(controller, config, 1, duration), config, bounds);
}

SimulationConfig smallStart() {
  SimulationConfig config;
  config.start = {0.0873, 0.0873, 0.1745, 0.01};
  return config;
}

TEST(Rates, TheLoopSettlesAndRestsAlike) {
  for (const Rates& rates : kAll) {
    const RunSummary summary = run(rates, smallStart(), 12.0, 8.0);
    EXPECT_NEAR(summary.settled, 2.0, 0.15) << rates.camera << ' ' << rates.control;
    EXPECT_LT(summary.centre_rms, 0.3) << rates.camera << ' ' << rates.control;
    EXPECT_LT(summary.moving_share, 0.1) << rates.camera << ' ' << rates.control;
    EXPECT_EQ(summary.holds, 0) << rates.camera << ' ' << rates.control;
    EXPECT_LT(summary.stopped, 0.0) << rates.camera << ' ' << rates.control;
  }
}

// How far it goes before the guard stops it.
TEST(Rates, AWrongPictureIsStoppedAlike) {
  for (const Rates& rates : kAll) {
    SimulationConfig config = smallStart();
    config.picture.roll = M_PI / 2.0;
    const RunSummary summary = run(rates, config, 8.0, 6.0);
    EXPECT_GE(summary.stopped, 0.0) << rates.camera << ' ' << rates.control;
    EXPECT_LT(summary.turned, 0.055) << rates.camera << ' ' << rates.control;
    EXPECT_LT(summary.inserted, 0.005) << rates.camera << ' ' << rates.control;
  }
}

}  // namespace
}  // namespace laparoscope_servo::closed_loop
