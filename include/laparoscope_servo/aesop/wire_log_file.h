// Writes the recording to files, on a disk that may be slow, full or gone: a separate thread writes, and an error ends
// the recording, never the driver.
//
// The present file is FILE. When it is full, and when the next recording begins, it becomes FILE.1, FILE.1 becomes
// FILE.2 and so on; the oldest is deleted.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "laparoscope_servo/aesop/wire_log.h"

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::aesop {

// Defaults are those of config/aesop.yaml, group `wire_log`.
struct WireLogConfig {
  std::string file;  // empty: no recording
  double size = 20;  // MB: of one file; an hour takes about 20
  int files = 5;     // number of files kept, including the present one
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, WireLogConfig& config);

std::vector<std::string> validate(const WireLogConfig& config);

class WireLogFile : public WireTap {
 public:
  // Throws nothing because of the disk. `codec`: name of the wire format.
  WireLogFile(const WireLogConfig& config, const std::string& codec);
  // Writes the remaining records.
  ~WireLogFile() override;

  // Never waits for the disk.
  void take(const WireRecord& record) override;
  // Why the recording has ended; empty while it is running.
  std::string problem() const;

 private:
  class Writer;
  std::unique_ptr<Writer> writer_;
};

}  // namespace laparoscope_servo::aesop
