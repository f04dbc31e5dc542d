// What a bad line does to bytes: loses, doubles, corrupts and delays them, or is cut. Pure and repeatable: the dice
// have a seed.
#pragma once

#include <deque>
#include <limits>
#include <random>
#include <string>

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::sim {

struct WireFaults {
  double drop = 0.0;       // 0 to 1: probability of a byte to get lost
  double corrupt = 0.0;    // 0 to 1: of one of its bits to flip
  double duplicate = 0.0;  // 0 to 1: of a byte to come twice
  double delay = 0.0;      // s, 0 to 10: of every byte
};

// One direction of the line.
class WireDirection {
 public:
  explicit WireDirection(std::uint32_t seed) : random_(seed) {}
  void push(const aesop::Bytes& bytes, const WireFaults& faults, double now);
  // What has come through by `now`, in order.
  aesop::Bytes pop(double now);
  void clear() { line_.clear(); }

 private:
  struct Piece {
    double at;
    aesop::Bytes bytes;
  };
  bool happens(double probability) { return std::uniform_real_distribution<double>(0.0, 1.0)(random_) < probability; }

  std::mt19937 random_;
  std::deque<Piece> line_;
};

class Wire {
 public:
  explicit Wire(std::uint32_t seed) : to_controller(seed), to_host(seed + 1) {}

  // Sets `drop`, `corrupt`, `double` or `delay`; `none` sets all to zero. `hangup` takes the port away, for `value` s
  // or, when that is 0, until `return`. Says why not.
  std::string set(const std::string& name, double value, double now);
  bool isCut(double now) const { return now < cut_until_; }

  WireFaults faults;
  WireDirection to_controller;
  WireDirection to_host;

 private:
  double cut_until_ = -std::numeric_limits<double>::infinity();
};

}  // namespace laparoscope_servo::sim
