#include "laparoscope_servo/sim/scene_config.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace laparoscope_servo::sim {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(SceneConfig, DefaultsAreValid) {
  EXPECT_TRUE(validate(SceneConfig()).empty());
}

TEST(SceneConfig, EachWrongFieldIsNamed) {
  const std::vector<std::pair<std::string, std::function<void(SceneConfig&)>>> mistakes = {
      {"camera/width", [](SceneConfig& c) { c.camera.width = 15; }},
      {"camera/height", [](SceneConfig& c) { c.camera.height = 5000; }},
      {"camera", [](SceneConfig& c) { c.camera.intrinsics.fx = 0.0; }},
      {"camera/rate", [](SceneConfig& c) { c.camera.rate = kNan; }},
      {"camera/supersampling", [](SceneConfig& c) { c.camera.supersampling = 0; }},
      {"camera/noise", [](SceneConfig& c) { c.camera.noise = -1.0; }},
      {"camera/noise_seed", [](SceneConfig& c) { c.camera.noise_seed = -1; }},
      {"camera/border_radius", [](SceneConfig& c) { c.camera.border_radius = kNan; }},
      {"tissue/seed", [](SceneConfig& c) { c.tissue.seed = -1; }},
      {"tissue/texture_side", [](SceneConfig& c) { c.tissue.texture_side = 8; }},
      {"tissue/width", [](SceneConfig& c) { c.tissue.width = 0.0; }},
      {"tissue/distance", [](SceneConfig& c) { c.tissue.distance = -0.1; }},
      {"tissue/tilt_x", [](SceneConfig& c) { c.tissue.tilt_x = 1.6; }},
      {"tissue/tilt_y", [](SceneConfig& c) { c.tissue.tilt_y = kNan; }},
      {"light/reference_distance", [](SceneConfig& c) { c.light.reference_distance = 0.0; }},
      {"light/beam_exponent", [](SceneConfig& c) { c.light.beam_exponent = -1.0; }},
      {"exposure/gain", [](SceneConfig& c) { c.exposure.gain = 0.0; }},
      {"exposure/target", [](SceneConfig& c) { c.exposure.target = 300.0; }},
      {"exposure/time_constant", [](SceneConfig& c) { c.exposure.time_constant = 0.0; }},
      {"instrument/radius", [](SceneConfig& c) { c.instrument.radius = 0.0; }},
      {"instrument/trocar[1]", [](SceneConfig& c) { c.instrument.trocar.y() = kNan; }},
      {"instrument/start[0]", [](SceneConfig& c) { c.instrument.start.x() = 11.0; }},
      {"instrument/end[2]", [](SceneConfig& c) { c.instrument.end.z() = -11.0; }},
      {"instrument/crossing_time", [](SceneConfig& c) { c.instrument.crossing_time = 0.0; }},
      {"instrument/period", [](SceneConfig& c) { c.instrument.period = -1.0; }},
  };
  SceneConfig all;
  for (const auto& [field, change] : mistakes) {
    SceneConfig config;
    change(config);
    change(all);
    const std::vector<std::string> errors = validate(config);
    ASSERT_EQ(errors.size(), 1U) << field;
    EXPECT_EQ(errors[0].rfind(field, 0), 0U) << errors[0];
  }
  EXPECT_EQ(validate(all).size(), mistakes.size());
}

}  // namespace
}  // namespace laparoscope_servo::sim
