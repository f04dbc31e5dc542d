// What can be set of the estimator of dominant motion. Defaults are those of config/motion.yaml.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/features/feature_state.h"
#include "laparoscope_servo/motion/motion_model.h"

namespace laparoscope_servo::motion {

struct MotionConfig {
  Model model = Model::kQuadratic;
  int max_pixels = 310000;        // an image with more is used at half its size, or a quarter, ...
  bool light = true;              // gain and offset of the light are estimated, else the light is taken for constant
  int saturation = 250;           // grey levels: in any channel, from there on a highlight; 256: none is
  int darkness = 20;              // grey levels: where no channel has more, nothing is seen
  double min_usable = 0.1;        // share of the image, or of the region in it, that is left after masking
  double min_share = 0.35;        // of the gradient energy that follows the motion
  double max_error = 0.5;         // px: standard deviation expected at the worst corner
  double velocity_damping = 0.8;  // share of the last motion that is expected to go on
  features::StateConfig state;
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, MotionConfig& config);

// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const MotionConfig& config);

}  // namespace laparoscope_servo::motion
