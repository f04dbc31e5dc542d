// Prints a recording as text: a line for every frame and event, and a summary at the end. Pure.
#pragma once

#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "laparoscope_servo/aesop/wire_log.h"

namespace laparoscope_servo::aesop {

// "velocity 0.2 s: -0.0004 0.003 ..." and so on.
std::string describe(const Message& message);
// Its first word.
std::string typeOf(const Message& message);

class WirePrinter {
 public:
  // `codec`: that of the recording.
  explicit WirePrinter(const CodecFactory& codec) : to_controller_(codec()), to_host_(codec()) {}

  // The lines of the next record, each with its time in s since `start` in front [ns].
  void print(const WireRecord& record, std::int64_t start, std::ostream& out);
  void printSummary(std::ostream& out) const;

 private:
  struct Direction {
    explicit Direction(std::unique_ptr<Codec> format) : codec(std::move(format)) {}
    std::unique_ptr<Codec> codec;
    std::uint64_t bytes = 0;
    std::map<std::string, std::uint64_t> frames;  // number of frames by type
  };

  void printBytes(const WireRecord& record, Direction& direction, const std::string& head, std::ostream& out);
  void count(const WireRecord& record, const Frame& frame);

  Direction to_controller_;
  Direction to_host_;
  std::int64_t first_ = 0;  // ns, of the first record
  std::int64_t last_ = 0;   // ns
  std::uint64_t records_ = 0;
  std::uint64_t turns_ = 0;
  std::int64_t last_turn_ = 0;                     // ns
  std::int64_t longest_turn_ = 0;                  // ns, between two cycles
  std::map<std::uint16_t, std::int64_t> sent_at_;  // ns, when requests that are not answered yet were sent
  std::vector<double> round_trips_;                // s
};

}  // namespace laparoscope_servo::aesop
