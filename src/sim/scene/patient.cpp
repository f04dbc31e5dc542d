#include "laparoscope_servo/sim/patient.h"

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/validation/range_checker.h"

namespace laparoscope_servo::sim {

namespace {

Eigen::Vector3d vector(const std::vector<double>& v) {
  return {v[0], v[1], v[2]};
}

void checkVector(const std::string& name, const std::vector<double>& v, double limit, const std::string& unit,
                 validation::RangeChecker& check) {
  if (v.size() != 3) {
    check.add(name + " has " + std::to_string(v.size()) + " elements, expected 3: x, y, z in " + unit);
    return;
  }
  for (std::size_t k = 0; k < 3; ++k) check.range(name + "[" + std::to_string(k) + "]", v[k], -limit, limit, unit);
}

// Where the k-th pull ends; before the first the tissue is at rest.
Eigen::Vector3d endOfPull(double k, double distance) {
  constexpr double kGoldenAngle = 2.399963;  // rad: no two pulls are alike
  if (!(k > 0.0)) return Eigen::Vector3d::Zero();
  return distance * Eigen::Vector3d(std::cos(kGoldenAngle * k), std::sin(kGoldenAngle * k), std::sin(k) / 3.0);
}

}  // namespace

std::vector<std::string> validate(const PatientConfig& config) {
  validation::RangeChecker check;
  const BreathingConfig& breathing = config.breathing;
  check.range("breathing/frequency", breathing.frequency, 0.02, 2.0, "Hz");
  check.range("breathing/second_harmonic", breathing.second_harmonic, 0.0, 1.0);
  check.range("breathing/third_harmonic", breathing.third_harmonic, 0.0, 1.0);
  check.range("breathing/start", breathing.start, 0.0, 1e9, "s");
  check.range("breathing/end", breathing.end, 0.0, 1e9, "s");
  checkVector("breathing/tissue", breathing.tissue, 0.1, "m", check);
  checkVector("breathing/trocar", breathing.trocar, 0.05, "m", check);
  check.range("pull/distance", config.pull.distance, 0.0, 0.1, "m");
  check.range("pull/time", config.pull.time, 0.05, 60.0, "s");
  check.range("pull/period", config.pull.period, std::max(0.05, config.pull.time), 1e9, "s");
  checkVector("drift", config.drift, 0.1, "m/s", check);
  check.range("drift_end", config.drift_end, 0.0, 1e9, "s");
  checkVector("jump", config.jump, 0.1, "m", check);
  check.range("jump_time", config.jump_time, 0.0, 1e9, "s");
  check.range("tilt", config.tilt, 0.0, 1.2, "rad");
  check.range("tilt_frequency", config.tilt_frequency, 0.001, 2.0, "Hz");
  return check.errors();
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
