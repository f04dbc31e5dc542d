// Finds the frequency of a periodic motion in a window of samples by least squares over a grid of frequencies.
//
// For each frequency, a parabola in time and three harmonics are fitted to each channel. The residual has a minimum at
// the frequency, and similar ones at half and a third of it, whose harmonics contain it. Among minima of about the same
// depth, the one at the highest frequency is taken.
#pragma once

#include <vector>

#include "servo/prediction/harmonic_kalman.h"

namespace laparoscope_servo::servo {

struct TimedChannels {
  double time = 0.0;  // s
  Channels z;
};

struct FrequencyBand {
  double minimum = 0.1;  // Hz
  double maximum = 0.5;  // Hz
};

struct FoundFrequency {
  bool found = false;
  double frequency = 0.0;    // Hz
  double unexplained = 1.0;  // 0 to 1, residual with harmonics over that of the parabola alone
};

// `samples` in order of time; `noise`: standard deviation of each. The lowest frequency tried has `min_periods` periods
// in the time of the samples.
FoundFrequency findFrequency(const std::vector<TimedChannels>& samples, const FrequencyBand& band, double noise,
                             double min_periods);

}  // namespace laparoscope_servo::servo
