// The steps of the demo in words, and how long they take, for who waits for them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace laparoscope_servo {

struct DemoStep {
  std::string what;
  double expected = 0.0;  // s
};

enum DemoStepIndex : std::size_t { kDemoNodes, kDemoSelect, kDemoHand, kDemoLoop, kDemoInstrument };

// In the order of DemoStepIndex; the times are those of DemoConfig [s]. Without the last one where no instrument
// crosses.
std::vector<DemoStep> demoSteps(double hand_time, double settled_time, bool cross_instrument);

// Of step `k`, when it begins: which of how many, what happens, for how long, and how long all of it still takes.
std::string announcement(const std::vector<DemoStep>& steps, std::size_t k);

}  // namespace laparoscope_servo
