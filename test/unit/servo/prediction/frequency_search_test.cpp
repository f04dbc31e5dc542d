#include "servo/prediction/frequency_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace laparoscope_servo::servo {
namespace {

constexpr double kNoise = 0.05;

struct Breath {
  double frequency = 0.25;  // Hz
  double amplitude = 2.0;
  double second = 0.4;  // share of the second harmonic
  double offset = 0.0;
  double drift = 0.0;  // per s, and half as much per s^2
  double begin = 0.0;  // s
  double length = 12.0;
  double rate = 25.0;
  double noise = kNoise;
};

// Two channels with two harmonics, as a breath has them.
std::vector<TimedChannels> samplesOf(const Breath& breath) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, breath.noise);
  std::vector<TimedChannels> samples;
  for (int k = 0; k <= breath.length * breath.rate; ++k) {
    const double t = k / breath.rate, a = 2.0 * M_PI * breath.frequency * t;
    TimedChannels sample{breath.begin + t, Channels(2)};
    const double drift = breath.drift * (t + 0.5 * t * t / breath.length);
    sample.z << breath.amplitude * (std::cos(a) + breath.second * std::sin(2.0 * a)) + drift + breath.offset +
                    normal(random),
        breath.amplitude * 0.5 * std::sin(a + 1.0) - drift + normal(random);
    samples.push_back(sample);
  }
  return samples;
}

double found(const Breath& breath, const FrequencyBand& band = {}) {
  const FoundFrequency result = findFrequency(samplesOf(breath), band, breath.noise, 1.0);
  EXPECT_TRUE(result.found);
  EXPECT_LT(result.unexplained, 0.05);
  return result.frequency;
}

TEST(FrequencySearch, FindsTheRateOfABreathOnTopOfADrift) {
  for (const double frequency : {0.17, 0.25, 0.33, 0.45}) {
    for (const double drift : {0.0, 1.5}) {
      Breath breath;
      breath.frequency = frequency;
      breath.drift = drift;
      EXPECT_NEAR(found(breath), frequency, 0.005) << drift;
    }
  }
}

// By their harmonics half and a third of a sinusoid's frequency explain it as well.
TEST(FrequencySearch, TakesTheHighestOfThoseThatExplainTheSamples) {
  Breath breath;
  breath.second = 0.0;
  breath.length = 20.0;
  for (const double frequency : {0.36, 0.42, 0.48}) {
    breath.frequency = frequency;
    EXPECT_NEAR(found(breath, {0.1, 0.5}), frequency, 0.005);
    EXPECT_NEAR(found(breath, {0.1, 0.3}), 0.5 * frequency, 0.005) << "where it is out of the band itself";
  }
}

TEST(FrequencySearch, SizeTimeAndRateOfTheSamplesDoNotMatter) {
  const double usual = found({});
  Breath breath;
  breath.amplitude *= 1e-3;
  breath.noise *= 1e-3;
  EXPECT_NEAR(found(breath), usual, 1e-3);
  breath = {};
  breath.offset = 1e5;
  EXPECT_NEAR(found(breath), usual, 1e-6);
  breath = {};
  breath.begin = 1e6;
  EXPECT_NEAR(found(breath), usual, 1e-6);
  for (const double rate : {12.5, 60.0}) {
    breath = {};
    breath.rate = rate;
    EXPECT_NEAR(found(breath), usual, 2e-3) << rate;
  }
}

TEST(FrequencySearch, NoiseAloneIsLeftUnexplained) {
  Breath breath;
  breath.amplitude = 0.0;
  const FoundFrequency result = findFrequency(samplesOf(breath), {}, kNoise, 1.0);
  EXPECT_GT(result.unexplained, 0.8);
  EXPECT_LE(result.unexplained, 1.0);
}

TEST(FrequencySearch, KeepsToTheBandAndToThePeriodsThatTheWindowHolds) {
  Breath breath;
  breath.length = 6.0;
  const std::vector<TimedChannels> samples = samplesOf(breath);
  const FoundFrequency in_band = findFrequency(samples, {0.3, 0.4}, kNoise, 1.0);
  EXPECT_GE(in_band.frequency, 0.3);
  EXPECT_LE(in_band.frequency, 0.4);
  EXPECT_GE(findFrequency(samples, {0.1, 0.5}, kNoise, 2.0).frequency, 2.0 / 6.0);
  EXPECT_FALSE(findFrequency(samples, {0.1, 0.3}, kNoise, 2.0).found) << "two periods of 0.3 Hz take longer";
}

TEST(FrequencySearch, TooFewSamplesOrNoTimeTellNothing) {
  std::vector<TimedChannels> samples = samplesOf({});
  samples.resize(17);
  EXPECT_FALSE(findFrequency(samples, {}, kNoise, 1.0).found);
  EXPECT_FALSE(findFrequency({}, {}, kNoise, 1.0).found);
  samples = samplesOf({});
  for (TimedChannels& sample : samples) sample.time = 3.0;
  EXPECT_FALSE(findFrequency(samples, {}, kNoise, 1.0).found);
}

}  // namespace
}  // namespace laparoscope_servo::servo
