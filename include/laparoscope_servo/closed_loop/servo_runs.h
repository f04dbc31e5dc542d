// Several runs of the closed loop (servo_simulation.h): their starts and results.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "laparoscope_servo/closed_loop/servo_simulation.h"

namespace laparoscope_servo::closed_loop {

struct DrawnStart {
  scope::Velocity start;  // rad and m, from the reference pose
  int refused = 0;        // number of starts drawn before in which the region of interest is not visible
};

// Uniform within config.start plus or minus config.start_spread; the same seed gives the same start. Without a spread
// it is config.start, also if the region is not visible there. Throws std::invalid_argument if the region is visible in
// hardly any start.
DrawnStart drawStart(const SimulationConfig& config, unsigned seed);

struct RunBounds {
  double centre = 1.0;                      // px, distance of the ROI's centre from its target
  double scale = 0.01;                      // relative to the reference: 0.01 is 1 %
  double orientation = 0.5 * M_PI / 180.0;  // rad
  double slant = 1.0 * M_PI / 180.0;        // rad, of the tissue against the image plane, in PARALLEL
  double rest_after = 15.0;                 // s, from which the figures of rest are computed
};

// Errors are true ones. Times are those after which the error stays within its bound; -1: it does not.
struct RunSummary {
  unsigned seed = 0;
  DrawnStart drawn;
  double settled = -1.0;  // s, for all three errors
  double settled_centre = -1.0;
  double settled_scale = -1.0;
  double settled_orientation = -1.0;
  double faced = -1.0;           // s, for the tissue's slant against the image plane
  double slant = 0.0;            // rad, that slant at the end
  double normal_error = -1.0;    // rad, of the normal that PARALLEL knows, when it became known; -1: none did
  bool left_image = false;       // a corner of the ROI was outside of the image at some time
  double centre_rms = 0.0;       // px, at rest, like the next four
  double scale_rms = 0.0;        // 0.01 is 1 %
  double orientation_rms = 0.0;  // rad
  double moving_share = 0.0;     // share of the time with a command other than zero
  int reversals = 0;             // changes of sign of the command's components, ignoring zeros, sum of all four
  double max_commanded_lateral_speed = 0.0;  // m/s, at the insertion point assumed by the controller
  double max_lateral_speed = 0.0;            // m/s, at the true insertion point
  double max_lateral_offset = 0.0;           // m
  servo::ControllerState final_state = servo::ControllerState::kIdle;
  double stopped = -1.0;  // s, time of LOST or FAULT; -1: none
  int holds = 0;          // number of times it went to HOLD
  // Largest displacement of the scope from the start, or from the time when the picture froze: rad, pan and tilt
  // together or spin; m.
  double turned = 0.0;
  double inserted = 0.0;
  // Largest increase of its displacement from the reference pose.
  double turned_away = 0.0;
  double inserted_away = 0.0;
  double evidence = 0.0;     // largest evidence of the effect guard while engaged; see src/servo/safety/effect_guard.h
  double unconfirmed = 0.0;  // largest used share of the effect budget
  double leash = 0.0;        // largest used share of the leash
};

RunSummary summariseRun(const std::vector<SimulationSample>& samples, const SimulationConfig& config,
                        const RunBounds& bounds);

// A header line and a line per run. SI units and px, as in RunSummary.
void writeRuns(const std::vector<RunSummary>& runs, std::ostream& stream);

// Prints a summary: how many settled and when, figures of rest, failed runs.
void printRuns(const std::vector<RunSummary>& runs, const RunBounds& bounds, std::ostream& stream);

}  // namespace laparoscope_servo::closed_loop
