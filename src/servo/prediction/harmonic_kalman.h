// Extended Kalman filter for channels that share a frequency; each has an offset (random walk) and harmonics.
//
// State: frequency f [Hz]; for each channel its offset and, for k = 1..harmonics, a phasor (c, s) that turns by 2 pi k
// f dt; c is the harmonic's contribution to the channel. All channels have the same unit.
#pragma once

#include <Eigen/Core>

namespace laparoscope_servo::servo {

constexpr int kMaxChannels = 4;
constexpr int kMaxHarmonics = 6;

// One value per channel; does not allocate.
using Channels = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxChannels, 1>;

class HarmonicKalman {
 public:
  static constexpr int kMaxStates = 1 + kMaxChannels * (1 + 2 * kMaxHarmonics);
  using State = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStates, 1>;
  using Covariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxStates, kMaxStates>;

  // Random walks, standard deviations per root of a second.
  struct Walks {
    double frequency = 0.0;  // Hz
    double offset = 0.0;     // the channels' unit
    double harmonics = 0.0;  // relative to the amplitude
  };

  // `harmonics` from 1 to kMaxHarmonics.
  explicit HarmonicKalman(int harmonics) : harmonics_(harmonics) {}

  // Starts at `z` with the given frequency and its standard deviation, and amplitudes of about `amplitude`.
  void start(double time, const Channels& z, double frequency, double frequency_stddev, double amplitude);

  // Predicts to `time`, which must not be before the last one.
  void predictTo(double time, const Walks& walks);

  // Adds `stddev` to the uncertainty of the offsets.
  void loosenOffset(double stddev);

  // Takes a sample at the predicted time; the frequency is kept within the bounds.
  void correct(const Channels& z, double stddev, double min_frequency, double max_frequency);

  double time() const { return time_; }
  double frequency() const { return x_[0]; }
  const State& state() const { return x_; }

  // Periodic part of a state, its derivative, and the offsets, `ahead` [s] later.
  Channels periodic(const State& state, double ahead) const;
  Channels periodicVelocity(const State& state, double ahead) const;
  Channels offset(const State& state) const;

 private:
  int channelCount(const State& state) const;
  int offsetIndex(int channel) const { return 1 + channel * (1 + 2 * harmonics_); }
  // Index of the phasor's first component; the second follows.
  int phasorIndex(int channel, int harmonic) const { return offsetIndex(channel) + 2 * harmonic - 1; }

  int harmonics_;
  double time_ = 0.0;
  State x_;
  Covariance p_;
  Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMaxStates> rows_;
  Eigen::Matrix<double, Eigen::Dynamic, 2, 0, kMaxStates, 2> columns_;
};

}  // namespace laparoscope_servo::servo
