// Extended Kalman filter of channels that share a frequency: each an offset that walks at random, and harmonics.
//
// State: frequency f [Hz]; for each channel its offset and, for k = 1..harmonics, a phasor (c, s) that turns by 2 pi k
// f dt, of which c is what the harmonic adds to the channel. All channels in one unit, any.
#pragma once

#include <Eigen/Core>

namespace laparoscope_servo::servo {

constexpr int kMaxChannels = 4;
constexpr int kMaxHarmonics = 6;

// A value per channel, without allocation.
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
    double harmonics = 0.0;  // over the amplitude
  };

  // `harmonics` from 1 to kMaxHarmonics.
  explicit HarmonicKalman(int harmonics) : harmonics_(harmonics) {}

  // Starts at `z`, knowing the frequency to `frequency_stddev` and the amplitudes to be about `amplitude`.
  void start(double time, const Channels& z, double frequency, double frequency_stddev, double amplitude);

  // To `time`, not before the last one.
  void predictTo(double time, const Walks& walks);

  // The offsets may have changed by as much as `stddev`.
  void loosenOffset(double stddev);

  // Takes a sample for the time predicted to; the frequency stays within the bounds.
  void correct(const Channels& z, double stddev, double min_frequency, double max_frequency);

  double time() const { return time_; }
  double frequency() const { return x_[0]; }
  const State& state() const { return x_; }

  // Of a state, `ahead` [s] later: what is periodic, its derivative, and the offsets.
  Channels periodic(const State& state, double ahead) const;
  Channels periodicVelocity(const State& state, double ahead) const;
  Channels offset(const State& state) const;

 private:
  int channelCount(const State& state) const;
  int offsetIndex(int channel) const { return 1 + channel * (1 + 2 * harmonics_); }
  // Of the first component of the phasor; the second follows.
  int phasorIndex(int channel, int harmonic) const { return offsetIndex(channel) + 2 * harmonic - 1; }

  int harmonics_;
  double time_ = 0.0;
  State x_;
  Covariance p_;
  Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMaxStates> rows_;
  Eigen::Matrix<double, Eigen::Dynamic, 2, 0, kMaxStates, 2> columns_;
};

}  // namespace laparoscope_servo::servo
