// What can be set of the tracker of models.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/features/edge_config.h"

namespace laparoscope_servo::model {

struct ModelConfig {
  features::EdgeConfig edges;
  double start_rotation = 30.0;  // deg about each axis, by which a start may be off
  double start_shift = 1.0;      // in the image, of the model's radius, by which a start may be off
  double start_share = 0.55;     // of the sites in the image, that have to agree with the pose at a start
  // nats per site, of the first 150: see features::EdgeReport::evidence. Of 560 images without the model none has more
  // than 1.05 (bench_model_chance).
  double start_evidence = 1.1;
  double start_margin = 0.13;  // nats per site, by which the evidence for any other pose has to be smaller
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, ModelConfig& config);

// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const ModelConfig& config);

}  // namespace laparoscope_servo::model
