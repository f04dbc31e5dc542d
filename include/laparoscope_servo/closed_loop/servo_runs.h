// Several runs of the closed loop (servo_simulation.h): where each starts, and what it comes to.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "laparoscope_servo/closed_loop/servo_simulation.h"

namespace laparoscope_servo::closed_loop {

struct DrawnStart {
  scope::Velocity start;  // rad and m, from the reference pose
  int refused = 0;        // starts drawn before that do not see the region of interest
};

// Uniform within config.start plus or minus config.start_spread; the same seed gives the same start. Without a spread
// it is config.start, whatever it sees. Throws std::invalid_argument when hardly any start sees the region.
DrawnStart drawStart(const SimulationConfig& config, unsigned seed);

struct RunBounds {
  double centre = 1.0;                      // px, of the ROI's centre from its target
  double scale = 0.01;                      // of the reference's: 0.01 is 1 %
  double orientation = 0.5 * M_PI / 180.0;  // rad
  double rest_after = 15.0;                 // s, from when on figures of rest are taken
};

// Errors are the true ones. Times are those after which the bound is never left again, -1: there is none.
struct RunSummary {
  unsigned seed = 0;
  DrawnStart drawn;
  double settled = -1.0;  // s, all three
  double settled_centre = -1.0;
  double settled_scale = -1.0;
  double settled_orientation = -1.0;
  bool left_image = false;       // a corner of the ROI was outside at some time
  double centre_rms = 0.0;       // px, at rest, as are the next four
  double scale_rms = 0.0;        // 0.01 is 1 %
  double orientation_rms = 0.0;  // rad
  double moving_share = 0.0;     // of the time, with a command that is not zero
  int reversals = 0;             // changes of sign of a component of the command, zeros left out, all four together
  double max_commanded_lateral_speed = 0.0;  // m/s, where the controller believes the insertion point to be
  double max_lateral_speed = 0.0;            // m/s, where it is
  double max_lateral_offset = 0.0;           // m
  servo::ControllerState final_state = servo::ControllerState::kIdle;
  double stopped = -1.0;  // s, when it went to LOST or FAULT; -1: it did not
  int holds = 0;          // how often it went to HOLD
  // How far the scope went from the start, or from when the picture froze: rad, pan and tilt together or spin; m.
  double turned = 0.0;
  double inserted = 0.0;
  // The same, of how far it went away from where the region is in its place.
  double turned_away = 0.0;
  double inserted_away = 0.0;
  double evidence = 0.0;  // of the guard of effect, the most while it was engaged; see src/servo/safety/effect_guard.h
  double unconfirmed = 0.0;  // share of the motion that it allows unseen, the most
};

RunSummary summariseRun(const std::vector<SimulationSample>& samples, const SimulationConfig& config,
                        const RunBounds& bounds);

// A header line and a line per run. SI units and px, as in RunSummary.
void writeRuns(const std::vector<RunSummary>& runs, std::ostream& stream);

// The same for a reader: how many settled and when, what they do at rest, which failed.
void printRuns(const std::vector<RunSummary>& runs, const RunBounds& bounds, std::ostream& stream);

}  // namespace laparoscope_servo::closed_loop
