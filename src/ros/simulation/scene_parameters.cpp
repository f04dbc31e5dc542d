#include "ros/simulation/scene_parameters.h"

#include <limits>

namespace laparoscope_servo {

namespace {

// Ranges are the core's to judge: validate() names them.
constexpr double kLarge = std::numeric_limits<double>::max();
constexpr int kLargeInt = std::numeric_limits<int>::max();

void readPoint(ParameterReader& reader, const std::string& path, Eigen::Vector3d& point) {
  std::vector<double> values(point.data(), point.data() + 3);
  reader.read(path, values, 3, -kLarge, kLarge);
  point = Eigen::Vector3d(values[0], values[1], values[2]);
}

void readCamera(ParameterReader& reader, sim::ScopeCameraConfig& camera) {
  reader.read("camera/width", camera.width, -kLargeInt, kLargeInt);
  reader.read("camera/height", camera.height, -kLargeInt, kLargeInt);
  reader.read("camera/fx", camera.intrinsics.fx, -kLarge, kLarge);
  reader.read("camera/fy", camera.intrinsics.fy, -kLarge, kLarge);
  reader.read("camera/cx", camera.intrinsics.cx, -kLarge, kLarge);
  reader.read("camera/cy", camera.intrinsics.cy, -kLarge, kLarge);
  reader.read("camera/rate", camera.rate, -kLarge, kLarge);
  reader.read("camera/supersampling", camera.supersampling, -kLargeInt, kLargeInt);
  reader.read("camera/noise", camera.noise, -kLarge, kLarge);
  reader.read("camera/noise_seed", camera.noise_seed, -kLargeInt, kLargeInt);
  reader.read("camera/border_radius", camera.border_radius, -kLarge, kLarge);
  reader.refuseUnknown("camera");
}

void readTissue(ParameterReader& reader, sim::TissueConfig& tissue) {
  reader.read("tissue/image", tissue.image);
  reader.read("tissue/seed", tissue.seed, -kLargeInt, kLargeInt);
  reader.read("tissue/texture_side", tissue.texture_side, -kLargeInt, kLargeInt);
  reader.read("tissue/width", tissue.width, -kLarge, kLarge);
  reader.read("tissue/distance", tissue.distance, -kLarge, kLarge);
  reader.read("tissue/tilt_x", tissue.tilt_x, -kLarge, kLarge);
  reader.read("tissue/tilt_y", tissue.tilt_y, -kLarge, kLarge);
  reader.refuseUnknown("tissue");
}

void readLight(ParameterReader& reader, sim::LightConfig& light, sim::ExposureConfig& exposure) {
  reader.read("light/reference_distance", light.reference_distance, -kLarge, kLarge);
  reader.read("light/beam_exponent", light.beam_exponent, -kLarge, kLarge);
  reader.refuseUnknown("light");
  reader.read("exposure/automatic", exposure.automatic);
  reader.read("exposure/gain", exposure.gain, -kLarge, kLarge);
  reader.read("exposure/target", exposure.target, -kLarge, kLarge);
  reader.read("exposure/time_constant", exposure.time_constant, -kLarge, kLarge);
  reader.refuseUnknown("exposure");
}

void readInstrument(ParameterReader& reader, sim::InstrumentConfig& instrument) {
  reader.read("instrument/radius", instrument.radius, -kLarge, kLarge);
  readPoint(reader, "instrument/trocar", instrument.trocar);
  readPoint(reader, "instrument/start", instrument.start);
  readPoint(reader, "instrument/end", instrument.end);
  reader.read("instrument/crossing_time", instrument.crossing_time, -kLarge, kLarge);
  reader.read("instrument/period", instrument.period, -kLarge, kLarge);
  reader.refuseUnknown("instrument");
}

}  // namespace

sim::SceneConfig readSceneConfig(ParameterReader& reader) {
  sim::SceneConfig config;
  readCamera(reader, config.camera);
  readTissue(reader, config.tissue);
  readLight(reader, config.light, config.exposure);
  readInstrument(reader, config.instrument);
  reader.addErrors(sim::validate(config));
  return config;
}

}  // namespace laparoscope_servo
