#include "laparoscope_servo/servo/task_config.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::servo {

void describe(parameters::Table& table, StabiliseConfig& c) {
  table.flag("spin", c.spin, "the scope's spin is used, as the parameter spin says; false: it does not spin");
  table.flag("insertion", c.insertion,
             "the distance to the tissue is kept; false: the scope does not move along its shaft");
  table.number("max_error", c.max_error, {0.1, 100}, "px",
               "expected error of the view at its worst corner; beyond it the scope stands");
}

void describe(parameters::Table& table, CentreTipConfig& c) {
  table.number("x", c.x, {-2, 2}, "px over the focal length", "the zone's middle, right of the principal point");
  table.number("y", c.y, {-2, 2}, "px over the focal length", "the zone's middle, below the principal point");
  table.number("inner", c.inner, {0.005, 2}, "px over the focal length",
               "distance of the tip from the zone's middle at which the scope stops");
  table
      .number("zone", c.zone, {0.01, 2}, "px over the focal length",
              "distance of the tip from the zone's middle from which on the scope moves")
      .atLeast("inner");
  table
      .number("leave", c.leave, {0.02, 5}, "px over the focal length",
              "distance of the tip from the zone's middle from which on it is not followed")
      .atLeast("zone");
  table.number("dwell", c.dwell, {0, 10}, "s", "the tip has to be held still for so long before the scope moves");
  table.number("still", c.still, {0.001, 1}, "px over the focal length", "distance within which a tip is held still");
  table.number("max_error", c.max_error, {0.1, 100}, "px", "expected error of the tip, beyond which the scope stands");
}

void describe(parameters::Table& table, FollowConfig& c) {
  table.number("x", c.x, {-2, 2}, "px over the focal length", "where the object is kept, right of the principal point");
  table.number("y", c.y, {-2, 2}, "px over the focal length", "where the object is kept, below the principal point");
  table.number("max_error", c.max_error, {0.1, 100}, "px",
               "expected error of the object's place, which grows from its selection on; beyond it the scope stands");
}

void describe(parameters::Table& table, PointsConfig& c) {
  table.number("min_points", c.min_points, {3, 500}, "points", "that have to agree for the scope to move");
  table.number("min_noise", c.min_noise, {1e-5, 0.1}, "px over the focal length",
               "standard deviation of a point's place: points that agree to it are not told apart");
  table.number("max_error", c.max_error, {0.1, 100}, "px",
               "expected error of where the points are together, beyond which the scope stands");
}

}  // namespace laparoscope_servo::servo
