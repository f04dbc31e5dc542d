#include "ros/simulation/demo_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace laparoscope_servo {

namespace {

// Measured on two cores: what a step takes besides the times that are parameters.
constexpr double kStart = 4.0;      // s, until all nodes answer
constexpr double kSelection = 1.0;  // s, until the region is tracked
constexpr double kReturn = 3.0;     // s, from the engagement until the region is back
constexpr double kCrossing = 4.0;   // s, from the call until the instrument has gone

std::string seconds(double time) {
  return std::to_string(std::max(1L, std::lround(time))) + " s";
}

}  // namespace

std::vector<DemoStep> demoSteps(double hand_time, double settled_time, bool cross_instrument) {
  std::vector<DemoStep> steps{
      {"the nodes of the simulated cart start", kStart},
      {"a region in the middle of the picture is selected", kSelection},
      {"a hand moves the scope away, and the tracker follows the region", hand_time},
      {"the arm is enabled, the controller engaged: the region comes back to its place", kReturn + settled_time}};
  if (cross_instrument)
    steps.push_back({"an instrument crosses the region, the loop goes on", kCrossing + settled_time});
  return steps;
}

std::string announcement(const std::vector<DemoStep>& steps, std::size_t k) {
  const double left = std::accumulate(steps.begin() + static_cast<std::ptrdiff_t>(k), steps.end(), 0.0,
                                      [](double sum, const DemoStep& step) { return sum + step.expected; });
  return "step " + std::to_string(k + 1) + " of " + std::to_string(steps.size()) + ": " + steps[k].what + " (about " +
         seconds(steps[k].expected) + "; about " + seconds(left) + " left)";
}

}  // namespace laparoscope_servo
