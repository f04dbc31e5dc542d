// The faults of the cart, a line each: what is wrong, in which situations it is tried, and what has to come of it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fault_cart.h"

namespace laparoscope_servo::test {

enum class Outcome {
  kStands,  // within the motion allowed, and stays so
  kGoesOn,  // the fault changes nothing: SERVO, and nearer to where the region has to be
  kEither,  // one or the other
};

struct FaultRow {
  std::string name;
  unsigned usually = 0;    // set of Situation: tried by the test suite
  unsigned otherwise = 0;  // and these where CART_FAULTS=all
  Outcome outcome = Outcome::kStands;
  std::string states;  // that the controller may then say, separated by blanks; empty: its process is the victim
  std::function<void(FaultCart&)> begin;
  std::function<void(FaultCart&)> end = [](FaultCart&) {};
  std::string stranger, says;  // who publishes beside the cart's own nodes, on which topic, and what, see stranger.cpp
  double rate = 50.0;          // Hz
  double watched = 0.0;        // s, where its effect needs time to show; 0: as long as the others
  double degrees = 3.0;        // allowed after the fault
  double millimetres = 5.0;
  bool bounded = false;  // also where it goes on to its task
  double later = 0.0;    // s, by which the arm does everything later: nothing stops it sooner
};

const std::vector<FaultRow>& faultTable();

}  // namespace laparoscope_servo::test
