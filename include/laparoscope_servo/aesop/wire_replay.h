// A recording run through a driver again: the same bytes, commands and requests at the same times give the same states
// and the same bytes to the controller, unless the driver or its configuration is another one than then. A recording
// that begins in the middle counts from the next opening of the port, and for its states only: the rhythm of the
// requests depends on what was before. Pure.
#pragma once

#include <optional>

#include "laparoscope_servo/aesop/driver.h"

namespace laparoscope_servo::aesop {

struct ReplayStatistics {
  std::uint64_t turns = 0;            // of the driver, since the first opening of the port in the recording
  std::uint64_t other_bytes = 0;      // turns in which it sent something else than recorded
  std::uint64_t other_states = 0;     // turns after which its state was another one
  std::optional<double> first_other;  // s, of the steady clock, of the first of those
};

class WireReplay {
 public:
  // Throws std::invalid_argument, as Driver does.
  explicit WireReplay(const DriverConfig& config) : driver_(config), requests_(config.session.codec()) {}

  // The next record. Throws std::invalid_argument when its payload is not what its event has.
  void feed(const WireRecord& record);
  // The recording has ended.
  void end();

  const Driver& driver() const { return driver_; }
  // After the last record.
  OperatingState state() const { return driver_.state(now_); }
  const ReplayStatistics& statistics() const { return statistics_; }

 private:
  void open();
  void turn(const WireRecord& record);
  void compare();

  Driver driver_;
  std::unique_ptr<Codec> requests_;           // as recorded, before the first opening
  std::optional<std::uint16_t> last_number_;  // of a request, before the first opening
  bool whole_ = true;                         // the recording begins with an opening
  double now_ = 0.0;
  bool begun_ = false;    // what was before the first opening is not known
  bool compared_ = true;  // the state after the last turn
  OperatingState recorded_;
  ReplayStatistics statistics_;
};

}  // namespace laparoscope_servo::aesop
