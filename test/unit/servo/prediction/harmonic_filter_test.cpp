#include "servo/prediction/harmonic_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace laparoscope_servo::servo {
namespace {

using Eigen::VectorXd;

constexpr double kNoise = 0.3;  // px
constexpr double kStep = 0.04;  // s

// Two channels that breathe: 37 px with a second harmonic of 30 %, by default.
class Target {
 public:
  explicit Target(unsigned seed) : random_(seed) {}

  double frequency = 0.25;  // Hz
  double amplitude = 37.0;  // px
  double second = 0.3;
  double offset = 0.0;  // px
  double drift = 0.0;   // px/sqrt(s)
  double scale = 1.0;   // of everything

  double breath(double phase) const {
    const double w = 2.0 * M_PI * phase;
    return amplitude * (std::cos(w) + second * std::cos(2.0 * w + 0.7));
  }
  double velocity() const { return scale * (breath(phase_ + 1e-6) - breath(phase_ - 1e-6)) / 2e-6 * frequency; }
  double change(double ahead) const { return scale * (breath(phase_ + frequency * ahead) - breath(phase_)); }

  VectorXd next(double dt) {
    phase_ += frequency * dt;
    offset += drift * std::sqrt(dt) * normal_(random_);
    VectorXd z(2);
    z[0] = scale * (100.0 + offset + breath(phase_) + kNoise * normal_(random_));
    z[1] = scale * (-50.0 + 0.5 * breath(phase_) + kNoise * normal_(random_));
    return z;
  }

  // Samples until `to`, an own one every `dt`.
  void run(
      HarmonicFilter& filter, double to, const std::function<void()>& after = [] {}, double dt = kStep) {
    while (time < to) {
      time += dt;
      ASSERT_TRUE(filter.update(time, next(dt), scale * kNoise));
      after();
    }
  }

  double time = 0.0;

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  double phase_ = 0.0;
};

HarmonicFilter filterOf(int channels = 2) {
  return HarmonicFilter(HarmonicFilterConfig(), channels);
}

// Root mean square, over 15 s, of what is wrong in the change that is predicted for the next quarter of a second.
double errorOver(Target& target, HarmonicFilter& filter) {
  double sum = 0.0;
  int n = 0;
  target.run(filter, target.time + 15.0, [&] {
    const VectorXd change = filter.predict(target.time + 0.25).position - filter.predict(target.time).position;
    sum += std::pow(change[0] - target.change(0.25), 2);
    ++n;
  });
  return std::sqrt(sum / n);
}

// Measured over 10 seeds: at most 0.17 px with the rate, 0.26 px without.
TEST(HarmonicFilter, PredictsBreathingAtAnyRate) {
  for (const double frequency : {0.12, 0.2, 0.25, 0.33, 0.45}) {
    for (const bool seeded : {true, false}) {
      Target target(1);
      target.frequency = frequency;
      HarmonicFilter filter = filterOf();
      if (seeded) filter.seed(frequency, 0.005);
      target.run(filter, 30.0);
      EXPECT_TRUE(filter.locked());
      EXPECT_LT(errorOver(target, filter), seeded ? 0.3 : 0.4) << frequency << " Hz, seeded " << seeded;
      EXPECT_NEAR(filter.frequency(), frequency, 0.001);
      EXPECT_NEAR(filter.predict(target.time).velocity[0], target.velocity(), 3.0);
      EXPECT_NEAR(filter.predict(target.time).velocity[1], 0.5 * target.velocity(), 3.0);
    }
  }
}

// After 40 s of a breath with a second harmonic of that share.
void expectFound(double frequency, double second) {
  Target target(2);
  target.frequency = frequency;
  target.second = second;
  HarmonicFilter filter = filterOf();
  target.run(filter, 40.0);
  EXPECT_NEAR(filter.frequency(), frequency, 0.002) << second;
}

// A pure sine is contained in the harmonics of half and a third of its frequency.
TEST(HarmonicFilter, TakesNoSubharmonic) {
  for (const double frequency : {0.25, 0.35, 0.45}) expectFound(frequency, 0.0);
}

TEST(HarmonicFilter, TakesNoHarmonic) {
  for (const double frequency : {0.12, 0.2}) expectFound(frequency, 0.9);
}

// Measured: at most 0.41 px.
TEST(HarmonicFilter, BearsDriftOfOffsetAndRate) {
  Target target(4);
  target.drift = 1.0;
  HarmonicFilter filter = filterOf();
  target.run(filter, 90.0, [&] { target.frequency = 0.25 * (1.0 + 0.02 * target.time / 60.0); });
  EXPECT_TRUE(filter.locked());
  EXPECT_LT(errorOver(target, filter), 0.7);
}

TEST(HarmonicFilter, DoesNotDependOnTheUnit) {
  Target target(5);
  target.scale = 1.0 / 400.0;
  HarmonicFilter filter = filterOf();
  target.run(filter, 30.0);
  EXPECT_LT(errorOver(target, filter), 0.4 / 400.0);
}

TEST(HarmonicFilter, IrregularSamplesWillDo) {
  Target target(6);
  HarmonicFilter filter = filterOf();
  std::mt19937 random(6);
  while (target.time < 40.0) {
    target.run(
        filter, target.time + 1e-9, [] {}, std::uniform_real_distribution<double>(0.01, 0.15)(random));
  }
  EXPECT_TRUE(filter.locked());
  EXPECT_LT(errorOver(target, filter), 0.5);
}

TEST(HarmonicFilter, NeverLocksToWhatIsNotPeriodic) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const std::function<double(double, double)> inputs[] = {
      [](double, double) { return 0.0; }, [&](double, double last) { return last + 1.0 * normal(random); },
      [&](double, double last) { return last + (normal(random) > 2.8 ? 40.0 * normal(random) : 0.0); },
      [](double time, double) { return 20.0 * std::sin(2.0 * M_PI * 0.04 * time); },
      [](double time, double) { return 15.0 * time; }};
  for (const auto& input : inputs) {
    for (const bool seeded : {true, false}) {
      HarmonicFilter filter = filterOf();
      if (seeded) filter.seed(0.25, 0.01);
      double value = 0.0;
      for (double time = 0.0; time < 150.0; time += kStep) {
        value = input(time, value);
        VectorXd z(2);
        z << value + kNoise * normal(random), 0.3 * value + kNoise * normal(random);
        filter.update(time, z, kNoise);
        ASSERT_FALSE(filter.locked()) << time;
        ASSERT_EQ(filter.predict(time + 0.25).position, VectorXd::Zero(2));
        ASSERT_EQ(filter.predict(time + 0.25).velocity, VectorXd::Zero(2));
      }
    }
  }
}

TEST(HarmonicFilter, JumpsOfTheTargetDoNotMatter) {
  Target target(8);
  HarmonicFilter filter = filterOf();
  target.run(filter, 30.0);
  for (const double jump : {100.0, -60.0, 25.0}) {
    target.offset += jump;
    EXPECT_LT(errorOver(target, filter), 0.5) << jump;
    EXPECT_TRUE(filter.locked());
  }
}

// How well depends on where in a breath it goes on.
TEST(HarmonicFilter, UnlocksWhenTheBreathIsHeldAndLocksAgain) {
  std::vector<double> errors;
  for (unsigned n = 1; n <= 30; ++n) {
    const bool seeded = n % 2 == 0;
    Target target(n);
    HarmonicFilter filter = filterOf();
    if (seeded) filter.seed(0.25, 0.005);
    target.run(filter, 40.0);
    ASSERT_TRUE(filter.locked());
    const double held = target.time;
    target.frequency = 0.0;
    double last_locked = held;
    target.run(filter, held + 10.0 + 0.43 * n, [&] {
      if (filter.locked()) last_locked = target.time;
    });
    EXPECT_LT(last_locked - held, 4.0);
    target.frequency = 0.25;
    target.run(filter, target.time + 25.0);
    EXPECT_TRUE(filter.locked());
    errors.push_back(errorOver(target, filter));
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.5);
}

TEST(HarmonicFilter, PredictsNothingFarAhead) {
  Target target(10);
  HarmonicFilter filter = filterOf();
  target.run(filter, 30.0);
  ASSERT_TRUE(filter.locked());
  EXPECT_GT(filter.predict(target.time + 0.5).position.norm() + filter.predict(target.time + 0.5).velocity.norm(), 1.0);
  for (const double time : {target.time + 1.1, target.time - 1.1, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(filter.predict(time).position, VectorXd::Zero(2));
    EXPECT_EQ(filter.predict(time).velocity, VectorXd::Zero(2));
  }
}

TEST(HarmonicFilter, StartsAnewAfterJumpsOfTime) {
  for (const double jump : {-20.0, 3.0}) {
    Target target(11);
    HarmonicFilter filter = filterOf();
    target.run(filter, 30.0);
    ASSERT_TRUE(filter.locked());
    target.time += jump;
    target.run(filter, target.time + 0.1, [&] { EXPECT_FALSE(filter.locked()); });
    target.run(filter, target.time + 30.0);
    EXPECT_TRUE(filter.locked());
  }
}

TEST(HarmonicFilter, RefusesWhatIsNoSample) {
  Target target(12);
  HarmonicFilter filter = filterOf();
  target.run(filter, 30.0);
  const VectorXd before = filter.predict(target.time).position;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double later = target.time + kStep;
  EXPECT_FALSE(filter.update(later, VectorXd::Zero(3), kNoise));
  EXPECT_FALSE(filter.update(later, VectorXd::Constant(2, nan), kNoise));
  EXPECT_FALSE(filter.update(nan, VectorXd::Zero(2), kNoise));
  EXPECT_FALSE(filter.update(later, VectorXd::Zero(2), 0.0));
  EXPECT_FALSE(filter.update(later, VectorXd::Zero(2), nan));
  EXPECT_FALSE(filter.update(target.time, VectorXd::Zero(2), kNoise));
  EXPECT_TRUE(filter.locked());
  EXPECT_EQ(filter.predict(target.time).position, before);
}

TEST(HarmonicFilter, RefusesWrongConfigurationsAndSeeds) {
  EXPECT_TRUE(validate(HarmonicFilterConfig()).empty());
  HarmonicFilterConfig config;
  config.harmonics = 7;
  config.max_frequency = 0.05;
  config.lock_ratio = std::numeric_limits<double>::quiet_NaN();
  EXPECT_GE(validate(config).size(), 3u);
  EXPECT_THROW(HarmonicFilter(config, 2), std::invalid_argument);
  EXPECT_THROW(filterOf(0), std::invalid_argument);
  EXPECT_THROW(filterOf(kMaxChannels + 1), std::invalid_argument);
  HarmonicFilter filter = filterOf();
  EXPECT_THROW(filter.seed(0.05, 0.01), std::invalid_argument);
  EXPECT_THROW(filter.seed(std::numeric_limits<double>::quiet_NaN(), 0.01), std::invalid_argument);
  EXPECT_THROW(filter.seed(0.25, -0.01), std::invalid_argument);
}

// The ventilator was set to another rate than somebody wrote down.
TEST(HarmonicFilter, AWrongSeedIsFoundOut) {
  for (const double seed : {0.12, 0.2, 0.4}) {
    Target target(13);
    HarmonicFilter filter = filterOf();
    filter.seed(seed, 0.002);
    target.run(filter, 30.0);
    EXPECT_TRUE(filter.locked()) << seed;
    EXPECT_NEAR(filter.frequency(), 0.25, 0.002) << seed;
    EXPECT_LT(errorOver(target, filter), 0.4) << seed;
  }
}

TEST(HarmonicFilter, ASeedMayBeTakenBack) {
  Target target(13);
  HarmonicFilter filter = filterOf();
  filter.seed(0.25, 0.001);
  target.run(filter, 30.0);
  EXPECT_TRUE(filter.locked());
  filter.unseed();
  EXPECT_FALSE(filter.locked());
  target.run(filter, 60.0);
  EXPECT_TRUE(filter.locked());
  EXPECT_NEAR(filter.frequency(), 0.25, 0.002);
}

// Where sums overflow nothing is found: no fit leaves less than nothing.
TEST(FrequencySearch, NumbersThatOverflowAreNoBreath) {
  std::vector<TimedChannels> samples;
  for (int k = 0; k < 100; ++k)
    samples.push_back({0.2 * k, Channels::Constant(1, 1e200 * std::sin(2.0 * M_PI * 0.25 * 0.2 * k))});
  EXPECT_FALSE(findFrequency(samples, FrequencyBand(), 1.0, 1.7).found);
  for (TimedChannels& sample : samples) sample.z *= 1e-200;
  const FoundFrequency found = findFrequency(samples, FrequencyBand(), 1e-3, 1.7);
  EXPECT_TRUE(found.found);
  EXPECT_NEAR(found.frequency, 0.25, 0.005);
  EXPECT_LT(found.unexplained, 0.01);
}

}  // namespace
}  // namespace laparoscope_servo::servo
