// Estimates periodic motion of the target, such as breathing: its frequency, and a prediction.
//
// Input: positions of the target as seen by a fixed camera, in any unit, with slow drifts and jumps that are not
// periodic. Output: prediction of the periodic part alone, with mean zero, and of its velocity.
//
// Until it is locked, the frequency is searched by least squares over a window (see frequency_search.h), or taken from
// a seed, such as the ventilator's rate; the samples of the window are then run through a Kalman filter with a state
// for the frequency (see harmonic_kalman.h). It locks when the filter's errors at the prediction horizon are much
// smaller than those of the better of two predictions without a period: the mean of the last samples, and the line
// through them. It unlocks when this no longer holds, within about a second if the prediction is worse than none.
// Unlocked, position and velocity are exactly zero.
//
// A jump of the target (another one selected, or the tissue pulled) is subtracted from all later samples.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <vector>

#include "laparoscope_servo/servo/harmonic_filter_config.h"
#include "servo/prediction/frequency_search.h"
#include "servo/prediction/harmonic_kalman.h"

namespace laparoscope_servo::servo {

struct PeriodicMotion {
  Eigen::VectorXd position;  // unit of the samples
  Eigen::VectorXd velocity;  // unit of the samples per second
};

class HarmonicFilter {
 public:
  // 1 to 4 channels that share a frequency and a unit. Throws std::invalid_argument with all errors when the
  // configuration or the number of channels is not valid.
  HarmonicFilter(const HarmonicFilterConfig& config, int channels);

  // Sets a known frequency [Hz] with its standard deviation; forgets the one found before. If no periodic motion is
  // found there, other frequencies are searched. Throws std::invalid_argument unless it lies within the bounds and the
  // standard deviation is at least 0 and finite.
  void seed(double frequency, double stddev);

  // Removes the known frequency.
  void unseed();

  // Takes a sample with its standard deviation, > 0, per channel. Returns false, without any effect, for a wrong size,
  // a non-finite value, or the time of the last one. If time goes back, or after a gap, all samples are forgotten, but
  // not the seed.
  bool update(double time, const Eigen::VectorXd& z, double stddev);

  void reset();

  bool locked() const { return locked_; }

  // Frequency [Hz]; 0 when not locked.
  double frequency() const { return locked_ ? kalman_.frequency() : 0.0; }

  // Prediction for a time up to a second after the last sample; zero when not locked, or for later times.
  PeriodicMotion predict(double time) const;

 private:
  struct Sample {
    double time = 0.0;
    double stddev = 0.0;
    bool jumped = false;
    Channels z;  // samples with jumps subtracted
  };
  struct Line {
    Channels value;  // at the last sample
    Channels slope;  // per second
  };
  struct Snapshot {
    double time = 0.0;
    HarmonicKalman::State state;
    Channels mean;
    Line line;
  };
  // Sums of squared errors, exponentially weighted.
  struct Errors {
    double with = 0.0;
    double mean = 0.0;
    double line = 0.0;
    double ratio() const;
    double without() const { return mean < line ? mean : line; }
  };

  Channels withoutJumps(double time, const Channels& z, double stddev, bool& jumped);
  Line lineUntil(std::size_t last, double seconds) const;
  Channels meanUntil(std::size_t last, double seconds) const;
  void start(double frequency);
  void step(std::size_t index);
  void score(const Sample& sample, double dt);
  double longMemory() const;
  void judge(double stddev);
  void startSearching();
  bool seeded() const { return seed_ && seed_counts_; }
  void search();
  FoundFrequency findIn(double seconds);
  FrequencyBand band() const;

  HarmonicFilterConfig config_;
  int channels_;
  std::optional<double> seed_;  // Hz
  double seed_stddev_ = 0.0;    // Hz
  std::deque<Sample> history_;
  std::deque<Snapshot> snapshots_;
  std::vector<TimedChannels> binned_;
  Channels shift_;  // sum of the jumps
  double usual_ = 0.0;
  HarmonicKalman kalman_;
  bool running_ = false;
  bool locked_ = false;
  double started_ = 0.0;  // s, when the Kalman filter was started
  double scored_ = 0.0;   // s, time over which predictions were compared
  Errors long_;
  Errors short_;
  double next_search_ = 0.0;  // s
  double share_ = 0.0;        // share of the samples in which to search next; 0: no search is running
  bool searched_ = false;
  bool seed_counts_ = true;
};

}  // namespace laparoscope_servo::servo
