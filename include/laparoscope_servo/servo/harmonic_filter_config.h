// Parameters of the filter for periodic motion.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo::servo {

struct HarmonicFilterConfig {
  double min_frequency = 0.1;      // Hz
  double max_frequency = 0.5;      // Hz
  int harmonics = 5;               // number of harmonics, the fundamental included, 1 to 6
  double horizon = 0.25;           // s, prediction horizon at which errors are measured; about that of its use
  double window = 30.0;            // s, of samples in which the frequency is searched
  double max_gap = 1.0;            // s, between samples; a longer one starts anew
  double variation = 0.002;        // 1/sqrt(s), random walk of the harmonics, over their amplitude
  double offset_walk = 3.0;        // 1/sqrt(s), random walk of the offset, over the samples' standard deviation
  double frequency_walk = 0.0004;  // 1/sqrt(s), random walk of the frequency, over the frequency
  double lock_ratio = 0.25;        // ratio of mean squared errors with and without the periodic part: locks below it
  double unlock_ratio = 0.6;       // unlocks above it; greater than lock_ratio
  // ratio of an innovation to the usual one from which it counts as a jump of the offset
  double jump = 8.0;
};

// Every error, each naming the field, its value and what was expected; empty when there is none.
std::vector<std::string> validate(const HarmonicFilterConfig& config);

}  // namespace laparoscope_servo::servo
