#include "ros/recording/recorder_config.h"

namespace laparoscope_servo {

namespace {

// Topics for replaying and analysing a case: results, commands, states, tf, the log.
const std::vector<std::string> kTopics{"tracker/homography",
                                       "tracker/task_error",
                                       "tracker/areas",
                                       "tracker/roi",
                                       "tracker/state",
                                       "controller/state",
                                       "controller/manual",
                                       "controller/stop",
                                       "servo_command",
                                       "dead_man",
                                       "aesop/operating_state",
                                       "aesop/measured_js",
                                       "aesop/measured_cp",
                                       "aesop/measured_cv",
                                       "aesop/stop",
                                       "camera/camera_info",
                                       "/tf",
                                       "/tf_static",
                                       "/diagnostics",
                                       "/rosout"};

}  // namespace

void describe(parameters::Table& table, RecorderConfig& c) {
  if (c.topics.empty()) c.topics = kTopics;
  table.text("folder", c.folder, "folder of the files; created if it does not exist")
      .required("/path/to/folder")
      .accepting("an absolute path", [](const std::string& text) { return !text.empty() && text[0] == '/'; });
  table.text("prefix", c.prefix, "of the files' names")
      .accepting("a name without a slash",
                 [](const std::string& text) { return !text.empty() && text.find('/') == std::string::npos; });
  table.texts("topics", c.topics, "beside the images");
  table.number("jpeg_quality", c.jpeg_quality, {1, 100}, "", "of the images");
  table.number("encoders", c.encoders, {1, 16}, "threads", "that encode images");
  table.number("waiting_images", c.waiting_images, {1, 1000}, "images", "that wait for an encoder; others are dropped");
  table.number("waiting_data", c.waiting_data, {1, 16384}, "MB", "waiting for the disk; further messages are dropped");
  table.number("split_size", c.split_size, {1, 1e6}, "MB", "of a file, then the next one begins");
  table.number("split_duration", c.split_duration, {1, 86400}, "s", "of a file, then the next one begins");
  table.number("min_free", c.min_free, {1, 1e6}, "MB", "with less on the disk nothing is written");
}

std::vector<std::string> validate(const RecorderConfig& config) {
  return parameters::errorsOf(config);
}

}  // namespace laparoscope_servo
