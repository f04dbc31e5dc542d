#include "laparoscope_servo/sim/scene_config.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::sim {

namespace {

using parameters::Range;
using parameters::Table;

constexpr double kAnySeed = 2147483647.0;

void describe(Table& table, ScopeCameraConfig& c) {
  table.number("width", c.width, {16, 4096}, "px", "of the images");
  table.number("height", c.height, {16, 4096}, "px", "of the images");
  table.number("fx", c.intrinsics.fx, Range::above(0, 1e5), "px", "focal length across");
  table.number("fy", c.intrinsics.fy, Range::above(0, 1e5), "px", "focal length down");
  table.number("cx", c.intrinsics.cx, {-1e5, 1e5}, "px", "principal point across");
  table.number("cy", c.intrinsics.cy, {-1e5, 1e5}, "px", "principal point down");
  table.number("rate", c.rate, {0.1, 1000}, "Hz", "of the images");
  table.number("supersampling", c.supersampling, {1, 4}, "samples", "per pixel along each axis");
  table.number("noise", c.noise, {0, 100}, "grey levels", "standard deviation");
  table.number("noise_seed", c.noise_seed, {0, kAnySeed}, "", "of that noise");
  table.number("border_radius", c.border_radius, {0, 1e4}, "px",
               "black outside this circle as in a real laparoscope; 0: none");
}

void describe(Table& table, TissueConfig& c) {
  table.text("image", c.image, "file name of a texture of your own; empty: made from the seed");
  table.number("seed", c.seed, {0, kAnySeed}, "", "of a texture that is made");
  table.number("texture_side", c.texture_side, {64, 8192}, "px", "of a texture that is made");
  table.number("width", c.width, Range::above(0, 10), "m", "of the texture, which is mirrored beyond its edges");
  table.number("distance", c.distance, Range::above(0, 10), "m",
               "along the optical axis from the camera at the arm's start pose");
  table.number("tilt_x", c.tilt_x, {-1.2, 1.2}, "rad", "about the x axis of the camera at the start pose");
  table.number("tilt_y", c.tilt_y, {-1.2, 1.2}, "rad", "then about the tissue's own y axis");
}

void describe(Table& table, LightConfig& c) {
  table.number("reference_distance", c.reference_distance, Range::above(0, 10), "m",
               "distance at which tissue seen squarely has the brightness of its texture");
  table.number("beam_exponent", c.beam_exponent, {0, 8}, "",
               "lamp and lens lose this power of the cosine of the angle to the optical axis");
}

void describe(Table& table, ExposureConfig& c) {
  table.flag("automatic", c.automatic, "false: the gain stays as it is");
  table.number("gain", c.gain, {0.01, 100}, "", "when not automatic");
  table.number("target", c.target, {1, 254}, "grey levels", "target mean of the image");
  table.number("time_constant", c.time_constant, Range::above(0, 1e3), "s", "of that motion");
}

void describe(Table& table, InstrumentConfig& c) {
  table.number("radius", c.radius, Range::above(0, 0.1), "m", "of its shaft");
  table.numbers("trocar", c.trocar.data(), 3, {-10, 10}, "m", "point through which the shaft enters");
  table.numbers("start", c.start.data(), 3, {-10, 10}, "m", "its tip when a crossing begins");
  table.numbers("end", c.end.data(), 3, {-10, 10}, "m", "its tip when a crossing ends");
  table.number("crossing_time", c.crossing_time, Range::above(0, 1e4), "s", "that a crossing takes");
  table.number("period", c.period, {0, 1e6}, "s",
               "from one crossing to the next; 0: only when ~cross_instrument is called");
}

}  // namespace

void describe(Table& table, SceneConfig& c) {
  table.group("camera", "", [&] { describe(table, c.camera); });
  table.group("tissue", "a plane", [&] { describe(table, c.tissue); });
  table.group("light", "at the tip of the scope", [&] { describe(table, c.light); });
  table.group("exposure", "", [&] { describe(table, c.exposure); });
  table.group("instrument", "points are in the tissue's frame: x right, y down, z into the tissue",
              [&] { describe(table, c.instrument); });
}

std::vector<std::string> validate(const SceneConfig& config) {
  return parameters::errorsOf(config);
}

}  // namespace laparoscope_servo::sim
