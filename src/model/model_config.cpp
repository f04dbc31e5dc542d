#include "laparoscope_servo/model/model_config.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::model {

void describe(parameters::Table& table, ModelConfig& c) {
  table.group("edges", "the edges of the model in the image", [&] { features::describe(table, c.edges); });
  table.number("start_rotation", c.start_rotation, {0, 60}, "deg", "about each axis, by which a start may be off");
  table.number("start_shift", c.start_shift, {0, 2}, "",
               "by which a start may be off in the image, as a share of the model's radius there");
  table.number("start_share", c.start_share, {0.1, 1}, "", "of the sites in the image, that agree with a start");
  table.number("start_evidence", c.start_evidence, {0, 10}, "nats",
               "per site in the image: how improbable it has to be that a start's edges agree by chance");
  table.number("start_margin", c.start_margin, {0, 10}, "nats",
               "per site in the image, by which the evidence for any other pose has to be smaller");
}

std::vector<std::string> validate(const ModelConfig& config) {
  return parameters::errorsOf(config);
}

}  // namespace laparoscope_servo::model
