// A fault of what the controller is told, or of the robot, and how such faults are made.
#pragma once

#include <functional>
#include <random>
#include <string>

#include "support/simulated_cart.h"

namespace laparoscope_servo::test {

struct CartFault {
  std::string name;
  // The scope has to stand while it lasts; otherwise the loop may go on.
  bool stops = true;
  // And it must not go on before somebody has engaged it again. What another fault hides, nobody knows.
  bool needs_somebody = false;
  bool of_picture = false;  // only its effect shows it
  bool blinds = false;      // takes away what an effect is judged by
  // Of an arm that nothing can stop sooner: s, by which it does everything later, and the factor by which it is faster.
  double later = 0.0;
  double faster = 1.0;
  Interference interference;
  std::function<void(SimulatedCart&)> begin, end;  // of what the robot does
  double from = 0.0;                               // s
  double until = 0.0;                              // s

  bool lasts(double time) const { return time >= from && time < until; }
};

inline CartFault withInput(const std::string& name, const std::function<void(servo::ControllerInput&, double)>& input) {
  CartFault fault;
  fault.name = name;
  fault.interference.input = input;
  return fault;
}

inline CartFault withInput(const std::string& name, const std::function<void(servo::ControllerInput&)>& input) {
  return withInput(name, [input](servo::ControllerInput& value, double) { input(value); });
}

inline CartFault withTracker(const std::string& name, const std::function<void(servo::TaskErrorInput&)>& tracker) {
  CartFault fault;
  fault.name = name;
  fault.interference.tracker = tracker;
  return fault;
}

inline CartFault withPicture(const std::string& name, const Eigen::Matrix3d& change) {
  CartFault fault;
  fault.name = name;
  fault.interference.picture = [change](Eigen::Matrix3d& h) { h = change * h * change.inverse(); };
  return fault;
}

inline CartFault withRobot(const std::string& name, const std::function<void(SimulatedCart&)>& begin,
                           const std::function<void(SimulatedCart&)>& end) {
  CartFault fault;
  fault.name = name;
  fault.begin = begin;
  fault.end = end;
  return fault;
}

inline CartFault bearable(CartFault fault) {
  fault.stops = false;
  return fault;
}

inline CartFault blinding(CartFault fault) {
  fault.blinds = true;
  return bearable(fault);
}

inline CartFault forSomebody(CartFault fault) {
  fault.needs_somebody = true;
  return fault;
}

// The same numbers on every machine.
class Draws {
 public:
  explicit Draws(unsigned seed) : random_(seed) {}

  double real(double from, double to) { return from + (to - from) * (static_cast<double>(random_()) / 4294967296.0); }
  int whole(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
  double sign() { return whole(2) == 0 ? -1.0 : 1.0; }

 private:
  std::mt19937 random_;
};

}  // namespace laparoscope_servo::test
