#include "laparoscope_servo/sim/patient.h"

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::sim {

namespace {

Eigen::Vector3d vector(const std::vector<double>& v) {
  return {v[0], v[1], v[2]};
}

// End of the k-th pull; before the first the tissue is at rest.
Eigen::Vector3d endOfPull(double k, double distance) {
  constexpr double kGoldenAngle = 2.399963;  // rad: makes all pulls different
  if (!(k > 0.0)) return Eigen::Vector3d::Zero();
  return distance * Eigen::Vector3d(std::cos(kGoldenAngle * k), std::sin(kGoldenAngle * k), std::sin(k) / 3.0);
}

}  // namespace

void describe(parameters::Table& table, PatientConfig& c) {
  table.group("breathing", "", [&] {
    table.number("frequency", c.breathing.frequency, {0.02, 2}, "Hz", "of the breath");
    table.number("second_harmonic", c.breathing.second_harmonic, {0, 1}, "share", "of the first one's amplitude");
    table.number("third_harmonic", c.breathing.third_harmonic, {0, 1}, "share", "of the first one's amplitude");
    table.number("start", c.breathing.start, {0, 1e9}, "s", "there is no breath before");
    table.number("end", c.breathing.end, {0, 1e9}, "s", "the breath is held from then on");
    table.numbers("tissue", c.breathing.tissue, 3, {-0.1, 0.1}, "m", "amplitude of the first harmonic: x, y, z");
    table.numbers("trocar", c.breathing.trocar, 3, {-0.05, 0.05}, "m",
                  "amplitude of the insertion point's first harmonic: x, y, z");
  });
  table.group("pull", "repeated pulls at the tissue, each to another place on a circle", [&] {
    table.number("distance", c.pull.distance, {0, 0.1}, "m",
                 "radius of the circle; nearer and further by a third of it");
    table.number("time", c.pull.time, {0.05, 60}, "s", "that a pull takes");
    table.number("period", c.pull.period, {0.05, 1e9}, "s", "from one pull to the next").atLeast("time");
  });
  table.numbers("drift", c.drift, 3, {-0.1, 0.1}, "m/s", "of the tissue: x, y, z");
  table.number("drift_end", c.drift_end, {0, 1e9}, "s", "the tissue drifts no longer");
  table.numbers("jump", c.jump, 3, {-0.1, 0.1}, "m", "the tissue is pulled so far: x, y, z");
  table.number("jump_time", c.jump_time, {0, 1e9}, "s", "when it is pulled");
  table.number("tilt", c.tilt, {0, 1.2}, "rad", "the tissue turns so far to and fro about the x axis");
  table.number("tilt_frequency", c.tilt_frequency, {0.001, 2}, "Hz", "of that turning");
}

std::vector<std::string> validate(const PatientConfig& config) {
  return parameters::errorsOf(config);
}

double Patient::breath(double time) const {
  const BreathingConfig& b = config_.breathing;
  if (time <= b.start) return 0.0;
  const double phase = 2.0 * M_PI * b.frequency * (std::min(time, b.end) - b.start);
  return std::sin(phase) + b.second_harmonic * std::sin(2.0 * phase) + b.third_harmonic * std::sin(3.0 * phase);
}

Eigen::Vector3d Patient::pulled(double time) const {
  const PullConfig& pull = config_.pull;
  const double k = std::floor(time / pull.period);
  const double share = std::min(1.0, (time - k * pull.period) / pull.time);
  const double smooth = 0.5 * (1.0 - std::cos(M_PI * share));
  return (1.0 - smooth) * endOfPull(k - 1.0, pull.distance) + smooth * endOfPull(k, pull.distance);
}

Eigen::Isometry3d Patient::tissueMotion(double time) const {
  Eigen::Vector3d moved =
      breath(time) * vector(config_.breathing.tissue) + std::min(time, config_.drift_end) * vector(config_.drift);
  if (time >= config_.jump_time) moved += vector(config_.jump);
  if (config_.pull.distance > 0.0) moved += pulled(time);
  const double angle = config_.tilt * std::sin(2.0 * M_PI * config_.tilt_frequency * time);
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = geometry::so3Exp({angle, 0.0, 0.0});
  motion.translation() = moved + target_ - motion.linear() * target_;
  return motion;
}

Eigen::Vector3d Patient::trocarOffset(double time) const {
  return breath(time) * vector(config_.breathing.trocar);
}

}  // namespace laparoscope_servo::sim
