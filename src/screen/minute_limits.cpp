#include "screen/minute_limits.h"

#include <cstdlib>

namespace laparoscope_servo::screen {

namespace {

double valueOf(const Facts& facts, const std::string& name) {
  if (!facts.parameters) return -1.0;
  for (const LiveParameter& parameter : *facts.parameters) {
    if (parameter.node == "tracker" && parameter.name == name) return std::strtod(parameter.value.c_str(), nullptr);
  }
  return -1.0;
}

}  // namespace

MinutePanel::Limits minuteLimits(const Facts& facts) {
  MinutePanel::Limits limits;
  limits[kConfidence] = {valueOf(facts, "tracking__quality__min_zncc"), true};
  limits[kCornerError] = {valueOf(facts, "tracking__quality__max_corner_error"), false};
  limits[kVisible] = {valueOf(facts, "tracking__quality__min_visible_fraction"), true};
  limits[kDelay] = {facts.max_image_age, false};
  return limits;
}

}  // namespace laparoscope_servo::screen
