// The tracker of models as nodelets and tools make it: by the file of an object.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/model/model_config.h"
#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo {

struct ModelFileConfig {
  std::string file;  // .cao, the whole path
  model::ModelConfig tracker;
};

void describe(parameters::Table& table, ModelFileConfig& config);
std::vector<std::string> validate(const ModelFileConfig& config);

}  // namespace laparoscope_servo
