// The noise of the simulation.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <random>

namespace laparoscope_servo::closed_loop {

// Normal noise by Box and Muller: the standard does not define the numbers of std::normal_distribution, and the same
// seed must give the same run everywhere.
class Noise {
 public:
  explicit Noise(unsigned seed) : random_(seed) {}
  Eigen::Vector2d draw(double sigma) {
    const double radius = sigma * std::sqrt(-2.0 * std::log(uniform()));
    const double angle = 2.0 * M_PI * uniform();
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }

 private:
  double uniform() { return (static_cast<double>(random_()) + 0.5) / 4294967296.0; }
  std::mt19937 random_;
};

}  // namespace laparoscope_servo::closed_loop
