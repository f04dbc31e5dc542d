// The recording as files on a disk that may be slow, full or gone: a thread of its own writes, and whatever goes wrong
// ends the recording, never the driver.
//
// FILE is the one that is written; it becomes FILE.1 when it is full, and when the next recording begins, FILE.1
// becomes FILE.2 and so on; the oldest is deleted.
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
  std::string file;  // none when empty: no recording
  double size = 20;  // MB: of one file; an hour takes about 20
  int files = 5;     // that are kept, the one being written among them
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, WireLogConfig& config);

std::vector<std::string> validate(const WireLogConfig& config);

class WireLogFile : public WireTap {
 public:
  // Throws nothing that comes from the disk. `codec`: the name of the wire format.
  WireLogFile(const WireLogConfig& config, const std::string& codec);
  // Writes what is left.
  ~WireLogFile() override;

  // Never waits for the disk.
  void take(const WireRecord& record) override;
  // Why the recording has ended; empty while it goes on.
  std::string problem() const;

 private:
  class Writer;
  std::unique_ptr<Writer> writer_;
};

}  // namespace laparoscope_servo::aesop
