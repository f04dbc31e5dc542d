#include "bench/support/configurations.h"

#include <stdexcept>

namespace laparoscope_servo::bench {

tracking::QualityConfig credulous() {
  tracking::QualityConfig quality;
  quality.min_zncc = 0.0;
  quality.min_visible_fraction = 0.0;
  quality.min_return_fraction = 0.0;
  quality.max_corner_error = 100.0;
  quality.max_area_ratio = 1000.0;
  quality.max_jump = 10.0;
  quality.confirmations = 1;
  return quality;
}

tracking::TrackerConfig configurationNamed(const std::string& name) {
  tracking::TrackerConfig config;
  if (name == "default") return config;
  if (name != "none" && name != "published") {
    throw std::invalid_argument("configuration \"" + name + "\", expected none, published or default");
  }
  config.occlusion.colour = name == "published" ? tracking::ColourGate::kPublished : tracking::ColourGate::kNone;
  config.occlusion.structure = false;
  config.esm.light = tracking::Light::kConstant;
  config.esm.robust = false;
  config.esm.saturation = 256;
  config.esm.channels = tracking::TrackedChannels::kLuma;
  return config;
}

std::vector<NamedConfig> gateConfigurations() {
  using tracking::ColourGate;
  const auto with = [](const char* name, ColourGate colour, bool structure, bool robust) {
    NamedConfig named = {name, {}};
    named.config.occlusion.colour = colour;
    named.config.occlusion.structure = structure;
    named.config.esm.robust = robust;
    return named;
  };
  return {with("none", ColourGate::kNone, false, false),
          with("published", ColourGate::kPublished, false, false),
          with("colour", ColourGate::kNormalised, false, false),
          with("structure", ColourGate::kNone, true, false),
          with("robust", ColourGate::kNone, false, true),
          with("colour+structure", ColourGate::kNormalised, true, false),
          {"default", {}}};
}

}  // namespace laparoscope_servo::bench
