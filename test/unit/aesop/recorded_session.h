// A driver against the emulator over a line that goes bad, recorded: for tests of recordings.
#pragma once

#include <sstream>
#include <vector>

#include "laparoscope_servo/aesop/driver.h"
#include "laparoscope_servo/sim/emulator.h"

namespace laparoscope_servo::aesop {

class RecordedTap : public WireTap {
 public:
  void take(const WireRecord& record) override { records.push_back(record); }
  std::vector<WireRecord> records;
};

inline Bytes encoded(const std::vector<WireRecord>& records, const WireLogHeader& header) {
  Bytes bytes;
  WireLogEncoder encoder;
  encoder.begin(header, bytes);
  for (const WireRecord& record : records) encoder.add(record, bytes);
  return bytes;
}

inline std::vector<WireRecord> decoded(const Bytes& bytes) {
  std::istringstream stream(std::string(bytes.begin(), bytes.end()));
  WireLogReader reader(stream);
  std::vector<WireRecord> records;
  while (const auto record = reader.next()) records.push_back(*record);
  return records;
}

// Plays 13 s of a session that has everything in it: enable, motion, pause, damaged bytes, a fault, a line that is cut,
// a port that goes and comes, stops with and without a reason.
class RecordedSession {
 public:
  RecordedSession() {
    driver_.setTap(&tap);
    driver_.opened(now_);
    run(0.5);
    driver_.enable(stamp(), now_);
    run(1.5, 0.05);
    driver_.pause();
    run(0.3, 0.05);
    driver_.resume(stamp());
    run(0.7, -0.05);
    damage_ = 7;
    run(1.0, 0.05);
    damage_ = 0;
    emulator_.setFaultCause(kFaultMotor, now_);
    run(0.5, 0.05);
    emulator_.setFaultCause(0, now_);
    driver_.clearFault(now_);
    run(0.5);
    driver_.setInsertionPoint(driver_.insertionPoint() + Eigen::Vector3d(0.001, 0.0, -0.001));
    driver_.enable(stamp(), now_);
    run(0.5, std::numeric_limits<double>::quiet_NaN());
    run(1.0, 0.05);
    cut_ = true;
    run(1.0, 0.05);
    driver_.closed("cable pulled");
    run(0.5);
    cut_ = false;
    driver_.opened(now_);
    run(1.0);
    driver_.enable(stamp(), now_);
    run(1.0, 0.05);
    driver_.disable(now_);
    run(0.5);
    driver_.enable(stamp(), now_);
    run(0.5, 0.05);
    driver_.stop(now_, "stopped by /somebody");
    run(0.5, 0.05);
  }

  RecordedTap tap;
  // One for each turn.
  std::vector<OperatingState> states;

 private:
  double stamp() const { return now_ + 1.6e9; }

  void run(double seconds, double pan = 0.0) {
    const double end = now_ + seconds;
    while (now_ < end) {
      now_ += 0.0050001;  // never a round number of anything
      if (pan != 0.0 && ++turns_ % 8 == 0) driver_.command({pan, 0.0, 0.01, 0.0}, stamp(), stamp(), now_);
      Bytes replies;
      replies.swap(on_the_way_);
      if (!cut_) driver_.receive(replies.data(), replies.size(), now_);
      const Bytes requests = driver_.transmit(now_);
      states.push_back(driver_.state(now_));
      on_the_way_ = emulator_.receive(requests.data(), cut_ ? 0 : requests.size(), now_);
      if (damage_ > 0 && !on_the_way_.empty() && turns_ % damage_ == 0)
        on_the_way_[turns_ % on_the_way_.size()] ^= 0x10;
    }
  }

  Driver driver_{DriverConfig()};
  sim::Emulator emulator_{sim::EmulatorConfig(), 100.0};
  double now_ = 100.0;
  std::size_t turns_ = 0;
  std::size_t damage_ = 0;
  bool cut_ = false;
  Bytes on_the_way_;
};

}  // namespace laparoscope_servo::aesop
