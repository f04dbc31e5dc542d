#include "servo/prediction/harmonic_kalman.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

namespace laparoscope_servo::servo {
namespace {

constexpr double kTwoPi = 2.0 * M_PI;
constexpr double kPeriod = 0.04;  // s

Channels two(double a, double b) {
  Channels z(2);
  z << a, b;
  return z;
}

// Two channels with an offset and two harmonics each, of 0.25 Hz.
Channels signal(double t) {
  const double a = kTwoPi * 0.25 * t;
  return two(3.0 + 5.0 * std::cos(a) + 1.0 * std::sin(2.0 * a + 0.4),
             -2.0 + 2.0 * std::sin(a) + 0.5 * std::cos(2.0 * a));
}

// The filter as textbooks have it: with dense matrices, and Joseph's form of the correction.
class DenseFilter {
 public:
  DenseFilter(int channels, int harmonics) : channels_(channels), harmonics_(harmonics) {}

  void start(const Channels& z, double frequency, double frequency_stddev, double amplitude) {
    const int size = 1 + channels_ * (1 + 2 * harmonics_);
    x = Eigen::VectorXd::Zero(size);
    p_ = Eigen::MatrixXd::Zero(size, size);
    x[0] = frequency;
    p_(0, 0) = std::pow(frequency_stddev, 2);
    for (int c = 0; c < channels_; ++c) {
      x[offset(c)] = z[c];
      p_(offset(c), offset(c)) = std::pow(2.0 * amplitude, 2);
      for (int k = 1; k <= harmonics_; ++k) {
        for (const int i : {0, 1}) p_(phasor(c, k) + i, phasor(c, k) + i) = std::pow(amplitude / k, 2);
      }
    }
  }
  void predict(double dt, const HarmonicKalman::Walks& walks) {
    Eigen::MatrixXd f = Eigen::MatrixXd::Identity(x.size(), x.size());
    Eigen::VectorXd moved = x, noise = Eigen::VectorXd::Zero(x.size());
    noise[0] = walks.frequency * walks.frequency * dt;
    for (int c = 0; c < channels_; ++c) {
      noise[offset(c)] = walks.offset * walks.offset * dt;
      for (int k = 1; k <= harmonics_; ++k) {
        const int i = phasor(c, k);
        const double angle = kTwoPi * k * x[0] * dt;
        f.block<2, 2>(i, i) << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
        moved.segment<2>(i) = f.block<2, 2>(i, i) * x.segment<2>(i);
        f.block<2, 1>(i, 0) << -kTwoPi * k * dt * moved[i + 1], kTwoPi * k * dt * moved[i];
      }
      const double amplitude = moved.segment(phasor(c, 1), 2 * harmonics_).norm();
      noise.segment(phasor(c, 1), 2 * harmonics_).setConstant(std::pow(walks.harmonics * amplitude, 2) * dt);
    }
    x = moved;
    p_ = f * p_ * f.transpose() + Eigen::MatrixXd(noise.asDiagonal());
  }
  void correct(const Channels& z, double stddev) {
    for (int c = 0; c < channels_; ++c) {
      Eigen::RowVectorXd h = Eigen::RowVectorXd::Zero(x.size());
      h[offset(c)] = 1.0;
      for (int k = 1; k <= harmonics_; ++k) h[phasor(c, k)] = 1.0;
      const double variance = h * p_ * h.transpose() + stddev * stddev;
      const Eigen::VectorXd gain = p_ * h.transpose() / variance;
      x += gain * (z[c] - h * x);
      const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(x.size(), x.size()) - gain * h;
      p_ = left * p_ * left.transpose() + stddev * stddev * gain * gain.transpose();
    }
  }
  void loosenOffset(double stddev) {
    for (int c = 0; c < channels_; ++c) p_(offset(c), offset(c)) += stddev * stddev;
  }

  Eigen::VectorXd x;

 private:
  int offset(int c) const { return 1 + c * (1 + 2 * harmonics_); }
  int phasor(int c, int k) const { return offset(c) + 2 * k - 1; }

  int channels_, harmonics_;
  Eigen::MatrixXd p_;
};

TEST(HarmonicKalman, IsTheTextbooksFilter) {
  const HarmonicKalman::Walks walks{0.004, 0.3, 0.1};
  HarmonicKalman filter(3);
  DenseFilter dense(2, 3);
  filter.start(0.0, signal(0.0), 0.22, 0.05, 4.0);
  dense.start(signal(0.0), 0.22, 0.05, 4.0);
  double time = 0.0;
  for (int k = 1; k <= 200; ++k) {
    const double dt = k % 7 == 0 ? 0.3 : kPeriod;  // images are lost
    time += dt;
    filter.predictTo(time, walks);
    dense.predict(dt, walks);
    if (k == 60) {
      filter.loosenOffset(2.0);
      dense.loosenOffset(2.0);
    }
    filter.correct(signal(time), 0.2, 0.05, 1.0);
    dense.correct(signal(time), 0.2);
    ASSERT_LT((filter.state() - dense.x).cwiseAbs().maxCoeff(), 1e-8) << "sample " << k;
  }
  EXPECT_DOUBLE_EQ(filter.time(), time);
}

TEST(HarmonicKalman, FindsFrequencyOffsetsAndWhatComes) {
  HarmonicKalman filter(2);
  filter.start(0.0, signal(0.0), 0.21, 0.05, 4.0);
  double time = 0.0;
  while (time < 40.0) {
    time += kPeriod;
    filter.predictTo(time, {});
    filter.correct(signal(time), 0.05, 0.05, 1.0);
  }
  EXPECT_NEAR(filter.frequency(), 0.25, 1e-3);
  EXPECT_LT((filter.offset(filter.state()) - two(3.0, -2.0)).norm(), 0.05);
  for (const double ahead : {0.0, 0.4, 1.0, 2.0}) {
    const Channels expected = filter.offset(filter.state()) + filter.periodic(filter.state(), ahead);
    EXPECT_LT((expected - signal(time + ahead)).norm(), 0.1) << ahead << " s ahead";
  }
}

TEST(HarmonicKalman, PredictingIsWhatThePeriodicPartSaysAhead) {
  HarmonicKalman filter(2);
  filter.start(0.0, signal(0.0), 0.25, 0.02, 4.0);
  for (double time = kPeriod; time < 6.0; time += kPeriod) {
    filter.predictTo(time, {});
    filter.correct(signal(time), 0.1, 0.05, 1.0);
  }
  const HarmonicKalman::State before = filter.state();
  const Channels ahead = filter.periodic(before, 0.7);
  filter.predictTo(filter.time() + 0.7, {0.01, 0.1, 0.2});
  EXPECT_LT((filter.periodic(filter.state(), 0.0) - ahead).norm(), 1e-9);
  EXPECT_EQ(filter.frequency(), before[0]);
  EXPECT_EQ(filter.offset(filter.state()), filter.offset(before));
}

TEST(HarmonicKalman, VelocityIsTheDerivative) {
  HarmonicKalman filter(3);
  filter.start(0.0, two(1.0, 2.0), 0.3, 0.02, 4.0);
  HarmonicKalman::State state = filter.state();
  for (int k = 0; k < state.size(); ++k) state[k] = k == 0 ? 0.3 : std::sin(1.7 * k);
  for (const double ahead : {-0.5, 0.0, 0.3, 4.0}) {
    constexpr double kStep = 1e-6;
    const Channels difference =
        (filter.periodic(state, ahead + kStep) - filter.periodic(state, ahead - kStep)) / (2.0 * kStep);
    EXPECT_LT((filter.periodicVelocity(state, ahead) - difference).norm(), 1e-6) << ahead;
  }
}

TEST(HarmonicKalman, ATimeThatIsNotLaterMovesNothing) {
  HarmonicKalman filter(1);
  filter.start(5.0, two(1.0, 2.0), 0.3, 0.02, 4.0);
  filter.predictTo(5.04, {});
  filter.correct(two(2.0, 1.0), 0.1, 0.05, 1.0);
  const HarmonicKalman::State before = filter.state();
  filter.predictTo(5.04, {1.0, 1.0, 1.0});
  EXPECT_EQ(filter.state(), before);
}

TEST(HarmonicKalman, TheFrequencyKeepsToItsBounds) {
  HarmonicKalman filter(1);
  filter.start(0.0, signal(0.0), 0.12, 0.2, 4.0);
  for (double time = kPeriod; time < 20.0; time += kPeriod) {
    filter.predictTo(time, {0.01, 0.1, 0.1});
    filter.correct(signal(time), 0.1, 0.1, 0.15);
    ASSERT_GE(filter.frequency(), 0.1);
    ASSERT_LE(filter.frequency(), 0.15);
  }
}

}  // namespace
}  // namespace laparoscope_servo::servo
