// Faults on demand: of the line, of the arm, and false statuses; at once, scheduled, or for a limited time.
// doc/aesop_emulator.md lists them.
//
// Pure: `now` is seconds from any start, the same as the emulator's.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "laparoscope_servo/sim/emulator.h"
#include "laparoscope_servo/sim/wire.h"

namespace laparoscope_servo::sim {

struct Fault {
  std::string name;
  std::string value;  // a number, or the name of a lie; empty: none
  std::string way;    // "to_controller" or "to_host", for faults of the line; empty: both
  double duration = std::numeric_limits<double>::infinity();  // s, after which the fault ends
};

struct ScheduledFault {
  double at = 0.0;  // s from now, or since the emulator's start
  Fault fault;
};

// Error of a fault's definition; empty if it is valid.
std::string error(const Fault& fault);
// Help text with a line for each fault.
std::string faultHelp();

class Faults {
 public:
  Faults(Emulator& emulator, Wire& wire) : emulator_(emulator), wire_(wire) {}

  // Begins a fault, or returns why not.
  std::string begin(const Fault& fault, double now);
  // Begins a fault later; `at` counts from `now`.
  std::string schedule(const ScheduledFault& fault, double now);
  // Begins and ends faults that are due.
  void step(double now);
  // s: time of the next event; infinite if there is none.
  double next() const;
  // Drops scheduled faults; present ones stay.
  void forget() { schedule_.clear(); }

 private:
  struct Event {
    double at;
    Fault fault;
    bool ends;
  };
  void add(const Event& event);
  void set(const Fault& fault, double now);
  void undo(const Fault& fault, double now);
  void clear(double now);

  Emulator& emulator_;
  Wire& wire_;
  std::vector<Event> schedule_;  // sorted by time
};

}  // namespace laparoscope_servo::sim
