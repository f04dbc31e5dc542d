#include "laparoscope_servo/sim/scene_config.h"

#include <sstream>

#include "laparoscope_servo/validation/range_checker.h"

namespace laparoscope_servo::sim {

namespace {

class Checker : public validation::RangeChecker {
 public:
  void positive(const std::string& field, double value, double maximum) {
    if (value > 0.0 && value <= maximum) return;
    std::ostringstream text;
    text << field << " = " << value << ", expected more than 0, at most " << maximum;
    add(text.str());
  }
  void position(const std::string& field, const Eigen::Vector3d& value) {
    for (int k = 0; k < 3; ++k) range(field + '[' + std::to_string(k) + ']', value[k], -10.0, 10.0);
  }
};

}  // namespace

std::vector<std::string> validate(const SceneConfig& config) {
  constexpr int kAnySeed = 2147483647;
  Checker check;
  const ScopeCameraConfig& camera = config.camera;
  check.range("camera/width", camera.width, 16, 4096);
  check.range("camera/height", camera.height, 16, 4096);
  const std::string intrinsics = camera.intrinsics.error();
  if (!intrinsics.empty()) check.add("camera: " + intrinsics);
  check.range("camera/rate", camera.rate, 0.1, 1000.0);
  check.range("camera/supersampling", camera.supersampling, 1, 4);
  check.range("camera/noise", camera.noise, 0.0, 100.0);
  check.range("camera/noise_seed", camera.noise_seed, 0, kAnySeed);
  check.range("camera/border_radius", camera.border_radius, 0.0, 1e4);

  const TissueConfig& tissue = config.tissue;
  check.range("tissue/seed", tissue.seed, 0, kAnySeed);
  check.range("tissue/texture_side", tissue.texture_side, 64, 8192);
  check.positive("tissue/width", tissue.width, 10.0);
  check.positive("tissue/distance", tissue.distance, 10.0);
  check.range("tissue/tilt_x", tissue.tilt_x, -1.2, 1.2);
  check.range("tissue/tilt_y", tissue.tilt_y, -1.2, 1.2);

  check.positive("light/reference_distance", config.light.reference_distance, 10.0);
  check.range("light/beam_exponent", config.light.beam_exponent, 0.0, 8.0);
  check.range("exposure/gain", config.exposure.gain, 0.01, 100.0);
  check.range("exposure/target", config.exposure.target, 1.0, 254.0);
  check.positive("exposure/time_constant", config.exposure.time_constant, 1e3);

  const InstrumentConfig& instrument = config.instrument;
  check.positive("instrument/radius", instrument.radius, 0.1);
  check.position("instrument/trocar", instrument.trocar);
  check.position("instrument/start", instrument.start);
  check.position("instrument/end", instrument.end);
  check.positive("instrument/crossing_time", instrument.crossing_time, 1e4);
  check.range("instrument/period", instrument.period, 0.0, 1e6);
  return check.errors();
}

}  // namespace laparoscope_servo::sim
