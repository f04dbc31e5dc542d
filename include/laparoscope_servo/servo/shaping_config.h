// Parameters of the shaping of the law's velocity: bands of rest, oscillation, dead zone, limits, workspace.
#pragma once

#include <vector>

#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::servo {

// The hysteresis band, see src/servo/shaping/hysteresis_band.h.
struct RestConfig {
  bool enabled = true;  // false: never at rest
  // distance of the ROI's centre from its desired place, normalised image coordinates: px over the focal length
  double centre_stop = 0.0004;
  double centre_start = 0.0014;
  double depth_stop = 0.0015;  // of log depth: 0.01 is 1 % of scale
  double depth_start = 0.005;
  double orientation_stop = 0.0015;  // rad
  double orientation_start = 0.005;
  double hunting_time = 1.5;  // s: a start within this time after a stop widens the band
  double widening = 1.3;      // no unit, factor each time
  double widest = 2.5;        // no unit, largest factor on the start thresholds
};

// Detection of oscillations of the loop, see src/servo/shaping/oscillation_guard.h.
struct OscillationConfig {
  bool enabled = true;
  double half_period = 0.95;   // s: changes of sign further apart are no oscillation
  int changes = 5;             // changes of sign in a row
  double centre = 0.003;       // normalised: least amplitude to each side
  double depth = 0.01;         // of log depth
  double orientation = 0.015;  // rad
  double step = 0.7;           // no unit: factor on the gain for each oscillation
  double least = 0.2;          // no unit: least factor on the gain
};

// The robot's dead zone, see src/servo/shaping/dead_zone.h.
struct DeadZoneConfig {
  bool inverse = true;                                 // false: the law's velocity is not compensated
  scope::Velocity width{0.004, 0.004, 0.004, 0.0004};  // rad/s, rad/s, rad/s, m/s: the robot does not move below it
};

// Limits of the slew limiter, see src/servo/shaping/slew_limiter.h.
struct Limits {
  scope::Velocity velocity{0.1, 0.1, 0.1, 0.02};     // rad/s, rad/s, rad/s, m/s
  scope::Velocity acceleration{1.0, 1.0, 1.0, 0.2};  // rad/s², rad/s², rad/s², m/s²
};

// The workspace: a range of depths, and a cone of directions about the insertion point.
struct Workspace {
  double min_depth = 0.03;     // m, of the camera beyond the insertion point, d2
  double max_depth = 0.22;     // m
  double depth_margin = 0.01;  // m, distance from a bound within which the scope is slowed
  std::vector<double> axis{0.0, 0.0,
                           // axis of the cone, in the insertion point's frame, into the body; of any length but 0
                           -1.0};
  double cone = 1.2;         // rad, largest angle between axis and shaft
  double cone_margin = 0.1;  // rad, angle from the bound within which the scope is slowed
};

}  // namespace laparoscope_servo::servo
