#include "ros/simulation/servo_simulation_config.h"

#include <limits>

namespace laparoscope_servo {

namespace {

void readScene(ParameterReader& reader, closed_loop::SimulationConfig& config) {
  const std::string group = "simulation/";
  reader.read(group + "duration", config.duration, 0.1, 36000.0);
  reader.read(group + "rest_from", config.rest_from, 0.0, 0.999);
  reader.read(group + "frame_rate", config.frame_rate, 1.0, 200.0);
  reader.read(group + "image_delay", config.image_delay, 0.0, 1.0);
  reader.read(group + "corner_noise", config.corner_noise, 0.0, 20.0);
  reader.read(group + "image/width", config.width, 16.0, 10000.0);
  reader.read(group + "image/height", config.height, 16.0, 10000.0);
  reader.read(group + "camera/fx", config.camera.fx, 1.0, 1e5);
  reader.read(group + "camera/fy", config.camera.fy, 1.0, 1e5);
  reader.read(group + "camera/cx", config.camera.cx, -1e5, 1e5);
  reader.read(group + "camera/cy", config.camera.cy, -1e5, 1e5);
  reader.read(group + "roi/x", config.roi.x, 0.0, 10000.0);
  reader.read(group + "roi/y", config.roi.y, 0.0, 10000.0);
  reader.read(group + "roi/width", config.roi.width, 2.0, 10000.0);
  reader.read(group + "roi/height", config.roi.height, 2.0, 10000.0);
  reader.read(group + "tissue/distance", config.tissue_distance, 0.005, 1.0);
  reader.read(group + "tissue/slant_x", config.tissue_slant_x, -1.2, 1.2);
  reader.read(group + "tissue/slant_y", config.tissue_slant_y, -1.2, 1.2);
}

void readScope(ParameterReader& reader, closed_loop::SimulationConfig& config) {
  const std::string group = "simulation/";
  reader.read(group + "scope/depth", config.depth, 0.005, 0.5);
  reader.read(group + "scope/length", config.scope_length, 0.01, 1.0);
  reader.read(group + "scope/believed_depth_factor", config.believed_depth_factor, 0.1, 10.0);
  reader.read(group + "scope/optics_angle", config.optics_angle, -1.3, 1.3);
  reader.read(group + "scope/optics_roll", config.optics_roll, -3.2, 3.2);
  std::string wrist = "stiff";
  reader.read(group + "scope/wrist", wrist, {"stiff", "passive"});
  config.wrist = wrist == "passive" ? sim::Wrist::kPassive : sim::Wrist::kStiff;
  reader.read(group + "start/pan", config.start.pan, -1.2, 1.2);
  reader.read(group + "start/tilt", config.start.tilt, -1.2, 1.2);
  reader.read(group + "start/spin", config.start.spin, -3.2, 3.2);
  reader.read(group + "start/insertion", config.start.insertion, -0.5, 0.5);
  reader.read(group + "start_spread/pan", config.start_spread.pan, 0.0, 1.2);
  reader.read(group + "start_spread/tilt", config.start_spread.tilt, 0.0, 1.2);
  reader.read(group + "start_spread/spin", config.start_spread.spin, 0.0, 3.2);
  reader.read(group + "start_spread/insertion", config.start_spread.insertion, 0.0, 0.5);
  reader.read(group + "reports", config.reports);
  reader.read(group + "report_noise", config.report_noise, 0.0, 1.0);
  reader.read(group + "poses", config.poses);
  reader.read(group + "pose_noise", config.pose_noise, 0.0, 0.1);
  reader.read(group + "direction_noise", config.direction_noise, 0.0, 0.5);
  reader.read(group + "robot/delay", config.robot.delay, 0.0, 2.0);
  reader.read(group + "robot/signs", config.signs, 4, -1.0, 1.0);
  reader.read(group + "picture/roll", config.picture.roll, -6.3, 6.3);
  reader.read(group + "picture/mirror", config.picture.mirror, {"none", "left_right", "up_down"});
  reader.read(group + "picture/frozen_from", config.picture.frozen_from, 0.0, 1e9);
  reader.read(group + "crossing/period", config.crossing.period, 0.0, 1e9);
  reader.read(group + "crossing/duration", config.crossing.duration, 0.01, 1e9);
  reader.read(group + "crossing/cover", config.crossing.cover, 0.0, 1.0);
  reader.read(group + "crossing/noise", config.crossing.noise, 1.0, 100.0);
  reader.read(group + "robot/dead_zone", config.robot.dead_zone, 4, 0.0, 1.0);
  reader.read(group + "robot/dead_zone_kind", config.robot.dead_zone_kind, {"subtract", "threshold"});
  for (const std::string& error : sim::validate(config.robot)) reader.addError("simulation/robot/" + error);
}

void readPatient(ParameterReader& reader, sim::PatientConfig& config) {
  const std::string group = "simulation/patient/";
  constexpr double kInfinity = std::numeric_limits<double>::infinity();  // the ranges are sim::validate's to judge
  reader.read(group + "breathing/frequency", config.breathing.frequency, -kInfinity, kInfinity);
  reader.read(group + "breathing/second_harmonic", config.breathing.second_harmonic, -kInfinity, kInfinity);
  reader.read(group + "breathing/third_harmonic", config.breathing.third_harmonic, -kInfinity, kInfinity);
  reader.read(group + "breathing/start", config.breathing.start, -kInfinity, kInfinity);
  reader.read(group + "breathing/end", config.breathing.end, -kInfinity, kInfinity);
  reader.read(group + "breathing/tissue", config.breathing.tissue, 3, -kInfinity, kInfinity);
  reader.read(group + "breathing/trocar", config.breathing.trocar, 3, -kInfinity, kInfinity);
  reader.read(group + "pull/distance", config.pull.distance, -kInfinity, kInfinity);
  reader.read(group + "pull/time", config.pull.time, -kInfinity, kInfinity);
  reader.read(group + "pull/period", config.pull.period, -kInfinity, kInfinity);
  reader.read(group + "drift", config.drift, 3, -kInfinity, kInfinity);
  reader.read(group + "drift_end", config.drift_end, -kInfinity, kInfinity);
  reader.read(group + "jump", config.jump, 3, -kInfinity, kInfinity);
  reader.read(group + "jump_time", config.jump_time, -kInfinity, kInfinity);
  reader.read(group + "tilt", config.tilt, -kInfinity, kInfinity);
  reader.read(group + "tilt_frequency", config.tilt_frequency, -kInfinity, kInfinity);
  for (const std::string& error : sim::validate(config)) reader.addError(group + error);
}

}  // namespace

closed_loop::SimulationConfig simulationConfig(ParameterReader& reader) {
  closed_loop::SimulationConfig config;
  readScene(reader, config);
  readScope(reader, config);
  readPatient(reader, config.patient);
  if (config.roi.x + config.roi.width > config.width || config.roi.y + config.roi.height > config.height) {
    reader.addError(
        "simulation/roi does not lie in the image, expected x + width and y + height within image/width, image/height");
  }
  const double spread = config.start_spread.insertion;
  if (!(config.depth + config.start.insertion - spread > 0.0)) {
    reader.addError(
        "simulation/start/insertion less start_spread/insertion pulls the camera out, expected more than minus "
        "scope/depth");
  }
  if (!(config.scope_length > config.depth + config.start.insertion + spread)) {
    reader.addError(
        "simulation/scope/length is too short, expected more than scope/depth + start/insertion + "
        "start_spread/insertion");
  }
  return config;
}

}  // namespace laparoscope_servo
