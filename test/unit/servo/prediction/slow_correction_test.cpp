#include "servo/prediction/slow_correction.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::servo {
namespace {

TEST(SlowCorrection, GoesWhereItIsWantedAtItsRateAndNoFurther) {
  SlowCorrection correction(0.005);
  correction.update(1.0, 0.01);
  EXPECT_EQ(correction.value(), 0.0);  // no time has passed yet
  EXPECT_EQ(correction.wanted(), 0.01);
  correction.update(2.0, 0.01);
  EXPECT_NEAR(correction.value(), 0.005, 1e-15);
  correction.update(9.0, 0.01);
  EXPECT_NEAR(correction.value(), 0.01, 1e-15);
  correction.update(10.0, -1.0);
  EXPECT_NEAR(correction.value(), 0.005, 1e-15);
}

TEST(SlowCorrection, TimeThatStandsOrGoesBackChangesNothing) {
  SlowCorrection correction(0.005);
  correction.update(1.0, 0.0);
  correction.update(1.0, 0.01);
  correction.update(0.0, 0.01);
  EXPECT_EQ(correction.value(), 0.0);
  correction.update(1.0, 0.01);
  EXPECT_NEAR(correction.value(), 0.005, 1e-15);
}

TEST(SlowCorrection, OfAClockThatJumpsAheadASecondCounts) {
  SlowCorrection correction(0.005);
  correction.update(1.0, 0.0);
  correction.update(1000.0, 75.0);
  EXPECT_NEAR(correction.value(), 0.005, 1e-15);
}

TEST(SlowCorrection, WhatIsNotFiniteIsNone) {
  SlowCorrection correction(0.005);
  correction.update(0.0, 0.01);
  correction.update(1.0, 0.01);
  correction.update(2.0, 0.01);
  correction.update(3.0, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(correction.wanted(), 0.0);
  EXPECT_NEAR(correction.value(), 0.005, 1e-15);
  correction.update(std::numeric_limits<double>::quiet_NaN(), 0.01);
  EXPECT_NEAR(correction.value(), 0.005, 1e-15);
}

}  // namespace
}  // namespace laparoscope_servo::servo
