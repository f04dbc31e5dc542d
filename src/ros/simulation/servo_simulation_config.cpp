#include "ros/simulation/servo_simulation_config.h"

#include <algorithm>

namespace laparoscope_servo {

using parameters::Range;
using parameters::Table;

namespace closed_loop {

namespace {

void describeImage(Table& table, SimulationConfig& c) {
  table.group("image", "", [&] {
    table.number("width", c.width, {16, 10000}, "px", "of the camera's images");
    table.number("height", c.height, {16, 10000}, "px", "of the camera's images");
  });
  table.group("camera", "", [&] {
    table.number("fx", c.camera.fx, {1, 1e5}, "px", "focal length across");
    table.number("fy", c.camera.fy, {1, 1e5}, "px", "focal length down");
    table.number("cx", c.camera.cx, {-1e5, 1e5}, "px", "principal point across");
    table.number("cy", c.camera.cy, {-1e5, 1e5}, "px", "principal point down");
  });
  table.group("roi", "in the reference image", [&] {
    table.number("x", c.roi.x, {0, 10000}, "px", "left edge");
    table.number("y", c.roi.y, {0, 10000}, "px", "upper edge");
    table.number("width", c.roi.width, {2, 10000}, "px", "x + width within image/width");
    table.number("height", c.roi.height, {2, 10000}, "px", "y + height within image/height");
  });
}

void describeScope(Table& table, SimulationConfig& c) {
  table.group("scope", "", [&] {
    table.number("depth", c.depth, {0.005, 0.5}, "m", "d2 at the reference pose");
    table.number("length", c.scope_length, {0.01, 1}, "m", "d1 + d2");
    table.number("believed_depth_factor", c.believed_depth_factor, {0.1, 10}, "times",
                 "factor on the true d2 for the controller and eq. (12)");
    table.number("optics_angle", c.optics_angle, {-1.3, 1.3}, "rad",
                 "between shaft and optical axis; 0.5236 is a 30 degree scope");
    table.number("optics_roll", c.optics_roll, {-3.2, 3.2}, "rad", "of the camera about the shaft");
    table.choice("wrist", c.wrist, {"stiff", "passive"},
                 "stiff: nothing holds the scope at the insertion point; passive: its direction follows it");
  });
  const auto motion = [&](scope::Velocity& v, double low, double about, double along, const std::string& what) {
    table.number("pan", v.pan, {low * 1.2, 1.2}, "rad", what + " about the insertion point, sideways");
    table.number("tilt", v.tilt, {low * 1.2, 1.2}, "rad", what + " about the insertion point, up and down");
    table.number("spin", v.spin, {low * about, about}, "rad", what + " about the shaft");
    table.number("insertion", v.insertion, {low * along, along}, "m", what + " along the shaft, deeper");
  };
  table.group("start", "from the reference pose", [&] { motion(c.start, -1.0, 3.2, 0.5, "turned or moved"); });
  table.group("start_spread", "of several runs each starts at random within start plus or minus this",
              [&] { motion(c.start_spread, 0.0, 3.2, 0.5, "at most"); });
}

void describeRobot(Table& table, SimulationConfig& c) {
  table.group("robot", "", [&] {
    describe(table, c.robot);
    table.numbers("signs", c.signs, 4, {-2, 2}, "", "factors on pan, tilt, spin, insertion; -1: reversed");
  });
  table.flag("reports", c.reports, "the robot reports its velocity");
  table.number("report_noise", c.report_noise, {0, 1}, "rad/s", "standard deviation; a tenth of it in m/s");
  table.flag("poses", c.poses, "the controller gets the shaft's pose, and may estimate the insertion point");
  table.number("pose_noise", c.pose_noise, {0, 0.1}, "m", "of the shaft's place, standard deviation per axis");
  table.number("direction_noise", c.direction_noise, {0, 0.5}, "rad",
               "of the shaft's direction, standard deviation per axis");
  table.number("pose_turn", c.pose_turn, {0.5, 2}, "times", "of the turns that the scope makes, what the poses tell");
}

void describeDisturbances(Table& table, SimulationConfig& c) {
  table.group("picture", "faults of the picture between scope and tracker", [&] {
    table.number("roll", c.picture.roll, {-6.3, 6.3}, "rad", "turned against the configured optics");
    table.choice("mirror", c.picture.mirror, {"none", "left_right", "up_down"}, "before it is rolled");
    table.number("frozen_from", c.picture.frozen_from, {0, 1e9}, "s",
                 "time from which the picture is frozen, with new noise, like that of another camera");
  });
  table.group("crossing", "instruments cross the region", [&] {
    table.number("period", c.crossing.period, {0, 1e9}, "s", "from one to the next; 0: none");
    table.number("duration", c.crossing.duration, {0.01, 1e9}, "s", "of a crossing");
    table.number("cover", c.crossing.cover, {0, 1}, "share",
                 "of the region that is covered in the middle of a crossing");
    table.number("noise", c.crossing.noise, {1, 100}, "times", "the noise of the corners, during a crossing");
  });
  table.group("patient", "in the camera's axes at the reference: x right, y down, z forward",
              [&] { describe(table, c.patient); });
}

}  // namespace

void describe(Table& table, SimulationConfig& c) {
  table.choice("task", c.task, {"HOLD_VIEW", "STABILISE", "CENTRE_TIP", "FOLLOW", "POINTS", "POSITION", "PARALLEL"},
               "which the controller does");
  table.number("duration", c.duration, {0.1, 36000}, "s", "of simulated time, where --duration is not given");
  table.number("rest_from", c.rest_from, {0, 0.999}, "share",
               "of the duration after which figures of rest are computed, if --rest-after is not given");
  table.number("frame_rate", c.frame_rate, {1, 200}, "Hz", "of the camera");
  table.number("image_delay", c.image_delay, {0, 1}, "s", "from the exposure to the task error");
  table.number("corner_noise", c.corner_noise, {0, 20}, "px",
               "standard deviation of each coordinate of the region's corners");
  table.number(
      "step_noise", c.step_noise, {0, 20}, "px",
      "standard deviation of the view's corners from an image to the next, where it is followed so, in PARALLEL");
  table.number("reading_time", c.reading_time, {0, 1000}, "s", "from PARALLEL's announcement to engaging again");
  table.number("points_astray", c.points_astray, {0, 1}, "share",
               "of the points of POINTS, that stand still in the image, as those on an instrument or on the lens");
  describeImage(table, c);
  table.group("tissue", "a plane", [&] {
    table.number("distance", c.tissue_distance, {0.005, 1}, "m", "Z*, along the reference camera's axis");
    table.number("slant_x", c.tissue_slant_x, {-1.2, 1.2}, "rad", "of the plane about the camera's x axis");
    table.number("slant_y", c.tissue_slant_y, {-1.2, 1.2}, "rad", "of the plane about the camera's y axis");
  });
  describeScope(table, c);
  describeRobot(table, c);
  describeDisturbances(table, c);
}

std::vector<std::string> validate(const SimulationConfig& c) {
  std::vector<std::string> errors = parameters::errorsOf(c);
  if (c.roi.x + c.roi.width > c.width || c.roi.y + c.roi.height > c.height) {
    errors.emplace_back(
        "roi does not lie in the image, expected x + width and y + height within image/width, image/height");
  }
  const double spread = c.start_spread.insertion;
  if (!(c.depth + c.start.insertion - spread > 0.0)) {
    errors.emplace_back(
        "start/insertion less start_spread/insertion pulls the camera out, expected more than minus scope/depth");
  }
  if (!(c.scope_length > c.depth + c.start.insertion + spread)) {
    errors.emplace_back(
        "scope/length is too short, expected more than scope/depth + start/insertion + start_spread/insertion");
  }
  return errors;
}

}  // namespace closed_loop

void describe(Table& table, ServoSimulationParameters& parameters) {
  describe(table, parameters.controller);
  table.group("simulation", "the simulated world", [&] { describe(table, parameters.simulation); });
}

std::vector<std::string> validate(const ServoSimulationParameters& parameters) {
  std::vector<std::string> errors = validate(parameters.controller);
  for (const std::string& error : closed_loop::validate(parameters.simulation)) errors.push_back("simulation/" + error);
  return errors;
}

}  // namespace laparoscope_servo
