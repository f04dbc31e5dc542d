// Faults on demand: of the line, of the arm, and statuses that lie; at once, at a time, for a time.
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
  std::string value;  // a number, or the name of a lie; empty when there is none
  std::string way;    // "to_controller" or "to_host", for faults of the line; empty: both
  double duration = std::numeric_limits<double>::infinity();  // s, until the fault is undone
};

struct ScheduledFault {
  double at = 0.0;  // s from now, or since the emulator's start
  Fault fault;
};

// Why there is no such fault, naming what is wrong; empty when there is.
std::string error(const Fault& fault);
// A line for each fault, for a command-line help.
std::string faultHelp();

class Faults {
 public:
  Faults(Emulator& emulator, Wire& wire) : emulator_(emulator), wire_(wire) {}

  // Begins a fault, or says why not.
  std::string begin(const Fault& fault, double now);
  // The same at a time; `at` counts from `now`.
  std::string schedule(const ScheduledFault& fault, double now);
  // Begins and ends what has fallen due.
  void step(double now);
  // s: when something falls due next; infinite when nothing does.
  double next() const;
  // Forgets what is scheduled; what has begun stays.
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
  std::vector<Event> schedule_;  // by time
};

}  // namespace laparoscope_servo::sim
