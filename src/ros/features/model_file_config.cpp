#include "ros/features/model_file_config.h"

namespace laparoscope_servo {

void describe(parameters::Table& table, ModelFileConfig& config) {
  table.text("file", config.file, "the object's shape, the whole path of a file .cao")
      .accepting("a path that begins with a slash",
                 [](const std::string& file) { return !file.empty() && file.front() == '/'; })
      .required("/path/to/object.cao");
  describe(table, config.tracker);
}

std::vector<std::string> validate(const ModelFileConfig& config) {
  return validate(config.tracker);
}

}  // namespace laparoscope_servo
