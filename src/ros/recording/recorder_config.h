// The parameters of the recorder.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo {

struct RecorderConfig {
  std::string folder;           // where the files go; made when it is not there
  std::string prefix = "case";  // of their names
  std::vector<std::string> topics;
  int jpeg_quality = 90;
  int encoders = 2;               // threads
  int waiting_images = 8;         // for an encoder; what comes beyond is dropped
  double waiting_data = 256.0;    // MB, for the disk; what comes beyond is dropped
  double split_size = 2048.0;     // MB, of a file
  double split_duration = 600.0;  // s, of a file
  double min_free = 2048.0;       // MB; with less on the disk nothing is written
};

// The private parameters.
void describe(parameters::Table& table, RecorderConfig& config);
std::vector<std::string> validate(const RecorderConfig& config);

}  // namespace laparoscope_servo
