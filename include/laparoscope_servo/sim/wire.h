// A bad line: loses, doubles, corrupts, delays and holds back bytes, or is cut. It also has a transmission time, ten
// bits a byte, which a pseudo-terminal does not. Pure and repeatable: the random numbers have a seed.
#pragma once

#include <algorithm>
#include <deque>
#include <limits>
#include <random>

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::sim {

struct WireFaults {
  double drop = 0.0;                                                // 0 to 1: probability that a byte is lost
  double corrupt = 0.0;                                             // 0 to 1: probability that one of its bits flips
  double duplicate = 0.0;                                           // 0 to 1: probability that a byte comes twice
  double delay = 0.0;                                               // s, 0 to 10: delay of every byte
  double stalled_until = -std::numeric_limits<double>::infinity();  // s: time until which the line holds back all bytes
};

// One direction of the line.
class WireDirection {
 public:
  // `baud_rate`: bit/s, 8N1; 0 for no transmission time.
  WireDirection(std::uint32_t seed, int baud_rate)
      : random_(seed), byte_time_(baud_rate > 0 ? 10.0 / baud_rate : 0.0) {}
  // Takes bytes from the sender. They are lost if too many are waiting.
  void push(const aesop::Bytes& bytes, double now);
  // The bytes that have arrived by `now`, in order.
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
  double sent_until_ = -1e9;  // s: when the last byte has been sent
  std::deque<Byte> line_;
};

class Wire {
 public:
  explicit Wire(std::uint32_t seed, int baud_rate = 0) : to_controller(seed, baud_rate), to_host(seed + 1, baud_rate) {}

  // Removes the port, with all bytes under way, until this time.
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
