// Runs a recording through a driver again: the same bytes, commands and requests at the same times give the same states
// and the same bytes to the controller, unless the driver or its configuration has changed. A recording that begins in
// the middle is compared from the next opening of the port on, and only by its states, since the timing of requests
// depends on earlier events. Pure.
#pragma once

#include <optional>

#include "laparoscope_servo/aesop/driver.h"

namespace laparoscope_servo::aesop {

struct ReplayStatistics {
  std::uint64_t turns = 0;            // cycles of the driver since the first opening of the port in the recording
  std::uint64_t other_bytes = 0;      // cycles in which it sent other bytes than recorded
  std::uint64_t other_states = 0;     // cycles after which its state differed
  std::optional<double> first_other;  // s, on the steady clock, of the first difference
};

class WireReplay {
 public:
  // Throws std::invalid_argument, as Driver does.
  explicit WireReplay(const DriverConfig& config) : driver_(config), requests_(config.session.codec()) {}

  // Takes the next record. Throws std::invalid_argument if its payload does not fit its event.
  void feed(const WireRecord& record);
  // Call at the end of the recording.
  void end();

  const Driver& driver() const { return driver_; }
  // The state after the last record.
  OperatingState state() const { return driver_.state(now_); }
  const ReplayStatistics& statistics() const { return statistics_; }

 private:
  void open();
  void turn(const WireRecord& record);
  void compare();

  Driver driver_;
  std::unique_ptr<Codec> requests_;           // decodes recorded requests before the first opening
  std::optional<std::uint16_t> last_number_;  // sequence number of the last request before the first opening
  bool whole_ = true;                         // the recording begins with an opening
  double now_ = 0.0;
  bool begun_ = false;    // false: before the first opening, where the history is not known
  bool compared_ = true;  // the state after the last cycle has been compared
  OperatingState recorded_;
  ReplayStatistics statistics_;
};

}  // namespace laparoscope_servo::aesop
