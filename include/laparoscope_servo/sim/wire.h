// What a bad line does to bytes: loses, doubles, corrupts, delays and withholds them, or is cut. It also takes its
// time: a pseudo-terminal carries a frame at once, a serial line ten bits a byte. Pure and repeatable: the dice have a
// seed.
#pragma once

#include <algorithm>
#include <deque>
#include <limits>
#include <random>

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::sim {

struct WireFaults {
  double drop = 0.0;                                                // 0 to 1: probability of a byte to get lost
  double corrupt = 0.0;                                             // 0 to 1: of one of its bits to flip
  double duplicate = 0.0;                                           // 0 to 1: of a byte to come twice
  double delay = 0.0;                                               // s, 0 to 10: of every byte
  double stalled_until = -std::numeric_limits<double>::infinity();  // s: until then all bytes wait on the line
};

// One direction of the line.
class WireDirection {
 public:
  // `baud_rate`: bit/s, 8N1; 0 for a line that takes no time.
  WireDirection(std::uint32_t seed, int baud_rate)
      : random_(seed), byte_time_(baud_rate > 0 ? 10.0 / baud_rate : 0.0) {}
  // Bytes that the sender hands over now. A line that is far behind its sender loses them.
  void push(const aesop::Bytes& bytes, double now);
  // What has come through by `now`, in order.
  aesop::Bytes pop(double now);
  // s: when the next byte comes through; infinite when none is under way.
  double next() const;
  void clear() { line_.clear(); }

  WireFaults faults;

 private:
  struct Byte {
    double at;
    std::uint8_t value;
  };
  bool happens(double probability) { return std::uniform_real_distribution<double>(0.0, 1.0)(random_) < probability; }
  void carry(std::uint8_t byte, double now);

  std::mt19937 random_;
  double byte_time_;          // s
  double sent_until_ = -1e9;  // s: when the last byte has left
  std::deque<Byte> line_;
};

class Wire {
 public:
  explicit Wire(std::uint32_t seed, int baud_rate = 0) : to_controller(seed, baud_rate), to_host(seed + 1, baud_rate) {}

  // Takes the port away, with all that is under way, until then.
  void cut(double until);
  bool isCut(double now) const { return now < cut_until_; }
  // s: when the next byte comes through; infinite when none is under way.
  double next() const { return std::min(to_controller.next(), to_host.next()); }

  WireDirection to_controller;
  WireDirection to_host;

 private:
  double cut_until_ = -std::numeric_limits<double>::infinity();
};

}  // namespace laparoscope_servo::sim
