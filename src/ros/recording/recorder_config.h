// The parameters of the recorder.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo {

struct RecorderConfig {
  std::string folder;           // folder of the files; created if it does not exist
  std::string prefix = "case";  // prefix of their names
  std::vector<std::string> topics;
  int jpeg_quality = 90;
  int encoders = 2;               // threads
  int waiting_images = 8;         // images waiting for an encoder; further ones are dropped
  double waiting_data = 256.0;    // MB waiting for the disk; further messages are dropped
  double split_size = 2048.0;     // MB, largest size of a file
  double split_duration = 600.0;  // s, longest duration of a file
  double min_free = 2048.0;       // MB; with less free disk space nothing is written
};

// Adds the rows of the private parameters.
void describe(parameters::Table& table, RecorderConfig& config);
std::vector<std::string> validate(const RecorderConfig& config);

}  // namespace laparoscope_servo
