// Pictures and axes that are not what they should be, of which each must stop every task.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iterator>
#include <vector>

#include "laparoscope_servo/closed_loop/servo_runs.h"
#include "laparoscope_servo/closed_loop/servo_simulation.h"

namespace laparoscope_servo::closed_loop {

struct Fault {
  const char* name;
  void (*apply)(SimulationConfig&);
};

inline constexpr Fault kWrongPictures[] = {
    {"mirrored, left for right", [](SimulationConfig& c) { c.picture.mirror = "left_right"; }},
    {"mirrored, up for down", [](SimulationConfig& c) { c.picture.mirror = "up_down"; }},
    {"rolled by 90 degrees", [](SimulationConfig& c) { c.picture.roll = 0.5 * M_PI; }},
    {"rolled by 180 degrees", [](SimulationConfig& c) { c.picture.roll = M_PI; }},
    {"frozen from the beginning", [](SimulationConfig& c) { c.picture.frozen_from = 0.0; }},
    {"pan reversed", [](SimulationConfig& c) { c.signs[0] = -1.0; }},
    {"tilt reversed", [](SimulationConfig& c) { c.signs[1] = -1.0; }},
};

inline std::vector<Fault> wrongPictures() {
  return {std::begin(kWrongPictures), std::end(kWrongPictures)};
}

// With one that begins while the scope moves.
inline std::vector<Fault> wrongPicturesAndFreezing() {
  std::vector<Fault> faults = wrongPictures();
  faults.push_back({"frozen from 0.6 s on", [](SimulationConfig& c) { c.picture.frozen_from = 0.6; }});
  return faults;
}

// Each fault in runs of `seconds`, one for each seed from 1 to `seeds`: the scope is stopped, and `check` says what
// else must hold.
inline void expectStopped(const std::vector<Fault>& faults, unsigned seeds, double seconds,
                          const std::function<SimulationConfig(unsigned seed)>& configOf,
                          const std::function<void(const RunSummary&)>& check) {
  for (const Fault& fault : faults) {
    for (unsigned seed = 1; seed <= seeds; ++seed) {
      SCOPED_TRACE(::testing::Message() << fault.name << ", seed " << seed);
      SimulationConfig config = configOf(seed);
      fault.apply(config);
      const RunSummary summary = summariseRun(simulate(ControllerSetup(), config, seed, seconds), config, RunBounds{});
      EXPECT_GE(summary.stopped, 0.0);
      check(summary);
    }
  }
}

}  // namespace laparoscope_servo::closed_loop
