#include "servo/prediction/harmonic_kalman.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::servo {

namespace {

constexpr double kTwoPi = 6.283185307179586;

}  // namespace

int HarmonicKalman::channelCount(const State& state) const {
  return static_cast<int>(state.size() - 1) / (1 + 2 * harmonics_);
}

void HarmonicKalman::start(double time, const Channels& z, double frequency, double frequency_stddev,
                           double amplitude) {
  const int channels = static_cast<int>(z.size());
  time_ = time;
  x_ = State::Zero(1 + channels * (1 + 2 * harmonics_));
  x_[0] = frequency;
  p_ = Covariance::Zero(x_.size(), x_.size());
  p_(0, 0) = frequency_stddev * frequency_stddev;
  for (int c = 0; c < channels; ++c) {
    x_[offsetIndex(c)] = z[c];
    p_(offsetIndex(c), offsetIndex(c)) = 4.0 * amplitude * amplitude;
    for (int k = 1; k <= harmonics_; ++k) {
      const int i = phasorIndex(c, k);
      p_(i, i) = p_(i + 1, i + 1) = amplitude * amplitude / (k * k);
    }
  }
}

void HarmonicKalman::predictTo(double time, const Walks& walks) {
  const double dt = time - time_;
  time_ = time;
  if (!(dt > 0.0)) return;
  const double f = x_[0];
  for (int c = 0; c < channelCount(x_); ++c) {
    for (int k = 1; k <= harmonics_; ++k) {
      const int i = phasorIndex(c, k);
      const double angle = kTwoPi * k * f * dt;
      Eigen::Matrix2d turn;
      turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
      const Eigen::Vector2d turned = turn * x_.segment<2>(i);
      x_.segment<2>(i) = turned;
      // P := F P F', where F turns this pair, adds the effect of the frequency to it, and leaves the rest unchanged.
      const Eigen::Vector2d by_frequency = kTwoPi * k * dt * Eigen::Vector2d(-turned[1], turned[0]);
      rows_ = turn * p_.middleRows<2>(i) + by_frequency * p_.row(0);
      p_.middleRows<2>(i) = rows_;
      columns_ = p_.middleCols<2>(i) * turn.transpose() + p_.col(0) * by_frequency.transpose();
      p_.middleCols<2>(i) = columns_;
    }
  }
  p_(0, 0) += walks.frequency * walks.frequency * dt;
  for (int c = 0; c < channelCount(x_); ++c) {
    p_(offsetIndex(c), offsetIndex(c)) += walks.offset * walks.offset * dt;
    const double amplitude = x_.segment(phasorIndex(c, 1), 2 * harmonics_).norm();
    const double q = walks.harmonics * walks.harmonics * amplitude * amplitude * dt;
    p_.diagonal().segment(phasorIndex(c, 1), 2 * harmonics_).array() += q;
  }
}

void HarmonicKalman::loosenOffset(double stddev) {
  for (int c = 0; c < channelCount(x_); ++c) p_(offsetIndex(c), offsetIndex(c)) += stddev * stddev;
}

void HarmonicKalman::correct(const Channels& z, double stddev, double min_frequency, double max_frequency) {
  for (int c = 0; c < channelCount(x_); ++c) {
    State ph = p_.col(offsetIndex(c));
    double predicted = x_[offsetIndex(c)];
    for (int k = 1; k <= harmonics_; ++k) {
      ph += p_.col(phasorIndex(c, k));
      predicted += x_[phasorIndex(c, k)];
    }
    double variance = stddev * stddev + ph[offsetIndex(c)];
    for (int k = 1; k <= harmonics_; ++k) variance += ph[phasorIndex(c, k)];
    x_ += ph * ((z[c] - predicted) / variance);
    p_ -= (ph * ph.transpose()) / variance;
  }
  p_ = (0.5 * (p_ + p_.transpose())).eval();
  x_[0] = std::clamp(x_[0], min_frequency, max_frequency);
}

Channels HarmonicKalman::periodic(const State& state, double ahead) const {
  Channels sum = Channels::Zero(channelCount(state));
  for (int k = 1; k <= harmonics_; ++k) {
    const double angle = kTwoPi * k * state[0] * ahead;
    for (int c = 0; c < sum.size(); ++c) {
      const int i = phasorIndex(c, k);
      sum[c] += std::cos(angle) * state[i] - std::sin(angle) * state[i + 1];
    }
  }
  return sum;
}

Channels HarmonicKalman::periodicVelocity(const State& state, double ahead) const {
  Channels sum = Channels::Zero(channelCount(state));
  for (int k = 1; k <= harmonics_; ++k) {
    const double rate = kTwoPi * k * state[0];
    for (int c = 0; c < sum.size(); ++c) {
      const int i = phasorIndex(c, k);
      sum[c] -= rate * (std::sin(rate * ahead) * state[i] + std::cos(rate * ahead) * state[i + 1]);
    }
  }
  return sum;
}

Channels HarmonicKalman::offset(const State& state) const {
  Channels offsets(channelCount(state));
  for (int c = 0; c < offsets.size(); ++c) offsets[c] = state[offsetIndex(c)];
  return offsets;
}

}  // namespace laparoscope_servo::servo
