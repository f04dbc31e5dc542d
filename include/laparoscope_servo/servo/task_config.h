// Parameters of the tasks, with the defaults that config/controller.yaml repeats.
#pragma once

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::servo {

// The task STABILISE.
struct StabiliseConfig {
  bool spin = false;       // the scope's spin is used, as the parameter `spin` says; false: it does not spin
  bool insertion = false;  // the distance to the tissue is kept by insertion; false: it does not move along the shaft
  double max_error = 2.0;  // px, expected error of the view at its worst corner, beyond which the scope stands
};

// The task CENTRE_TIP. Distances are from the zone's middle, normalised: px over the focal length.
struct CentreTipConfig {
  double x = 0.0;          // the zone's middle in the image, normalised
  double y = 0.0;          // second coordinate
  double inner = 0.1;      // distance at which the scope stops
  double zone = 0.15;      // distance from which on it moves; within it nothing moves once it has stopped
  double leave = 0.5;      // distance from which on the tip is taken to leave, and is not followed
  double dwell = 0.5;      // s, for which the tip has to be held still before the scope begins to move
  double still = 0.02;     // distance within which a tip is held still
  double max_error = 4.0;  // px, expected error of the tip, beyond which the scope stands
};

// The task FOLLOW.
struct FollowConfig {
  double x = 0.0;          // where the object is kept in the image, normalised: px over the focal length
  double y = 0.0;          // second coordinate
  double max_error = 8.0;  // px, expected error of the object's place since it was selected, beyond which it stands
};

// The task POINTS.
struct PointsConfig {
  int min_points = 4;       // that have to agree; with two the motion is determined, and no wrong one shows
  double min_noise = 5e-4;  // normalised, standard deviation of a point's place: the robust scale is no less
  double max_error = 2.0;   // px, expected error of the points' common place, beyond which the scope stands
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, StabiliseConfig& config);
void describe(parameters::Table& table, CentreTipConfig& config);
void describe(parameters::Table& table, FollowConfig& config);
void describe(parameters::Table& table, PointsConfig& config);

}  // namespace laparoscope_servo::servo
