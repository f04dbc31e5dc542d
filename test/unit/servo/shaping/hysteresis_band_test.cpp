#include "servo/shaping/hysteresis_band.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::servo {
namespace {

TaskError off(double x, double y, double log_depth, double alpha) {
  TaskError error;
  error.x = x + 0.1;
  error.y = y;
  error.desired_x = 0.1;
  error.log_depth = log_depth;
  error.alpha = alpha;
  error.e_v = {x, y, log_depth};
  error.e_w = {0.0, 0.0, alpha};
  return error;
}

bool centreMoves(const TaskError& error) {
  return error.x != error.desired_x || error.y != error.desired_y;
}

TEST(HysteresisBand, StartsAtOneBoundAndStopsAtALowerOne) {
  const RestConfig config;
  HysteresisBand band(config);
  EXPECT_FALSE(centreMoves(band.apply(off(0.99 * config.centre_start, 0, 0, 0), 0.0)));
  EXPECT_TRUE(centreMoves(band.apply(off(0, -1.01 * config.centre_start, 0, 0), 0.0)));
  EXPECT_TRUE(centreMoves(band.apply(off(1.01 * config.centre_stop, 0, 0, 0), 0.0)));
  EXPECT_FALSE(centreMoves(band.apply(off(0.99 * config.centre_stop, 0, 0, 0), 0.0)));
  EXPECT_FALSE(centreMoves(band.apply(off(0.99 * config.centre_start, 0, 0, 0), 0.0)));
}

TEST(HysteresisBand, FeaturesRestApart) {
  const RestConfig config;
  HysteresisBand band(config);
  const TaskError error = band.apply(off(0.0, 0.0, 2.0 * config.depth_start, 0.5 * config.orientation_start), 0.0);
  EXPECT_FALSE(centreMoves(error));
  EXPECT_EQ(error.log_depth, 2.0 * config.depth_start);
  EXPECT_EQ(error.alpha, 0.0);
  EXPECT_EQ(error.e_v.head<2>().norm(), 0.0);
  EXPECT_NE(error.e_v.z(), 0.0);
  EXPECT_EQ(error.e_w.norm(), 0.0);
}

TEST(HysteresisBand, WhatMovesIsPassedOnAsItIs) {
  HysteresisBand band{RestConfig()};
  const TaskError error = off(0.1, 0.2, 0.3, 0.4);
  const TaskError same = band.apply(error, 0.0);
  EXPECT_EQ(same.x, error.x);
  EXPECT_EQ(same.e_v, error.e_v);
  EXPECT_EQ(same.e_w, error.e_w);
}

TEST(HysteresisBand, ResetIsRest) {
  const RestConfig config;
  HysteresisBand band(config);
  band.apply(off(1.0, 1.0, 1.0, 1.0), 0.0);
  band.reset();
  EXPECT_FALSE(centreMoves(band.apply(off(0.9 * config.centre_start, 0, 0, 0), 0.0)));
}

// A robot that goes too far each time it is started.
TEST(HysteresisBand, GrowsUntilWhatIsHuntedRests) {
  const RestConfig config;
  HysteresisBand band(config);
  const double overshoot = 1.5 * config.centre_start;
  int starts = 0;
  double x = overshoot;
  for (double t = 0.0; t < 60.0; t += 0.5) {
    if (!centreMoves(band.apply(off(x, 0, 0, 0), t))) continue;
    ++starts;
    band.apply(off(0.0, 0, 0, 0), t + 0.25);  // it passes the target, and stops too late
    x = -x;
  }
  EXPECT_GE(starts, 2);
  EXPECT_LE(starts, 4);
  // A new way to go is servoed as well as ever.
  band.apply(off(0.5, 0, 0, 0), 100.0);
  band.apply(off(0.0, 0, 0, 0), 105.0);
  EXPECT_TRUE(centreMoves(band.apply(off(1.01 * config.centre_start, 0, 0, 0), 110.0)));
}

TEST(HysteresisBand, NotANumberIsNoRest) {
  HysteresisBand band{RestConfig()};
  EXPECT_TRUE(std::isnan(band.apply(off(std::nan(""), 0, 0, 0), 0.0).x));
  EXPECT_TRUE(std::isnan(band.apply(off(0, 0, std::nan(""), 0), 0.0).log_depth));
}

TEST(HysteresisBand, SwitchedOffNothingRests) {
  RestConfig config;
  config.enabled = false;
  HysteresisBand band(config);
  EXPECT_TRUE(centreMoves(band.apply(off(1e-9, 0, 0, 0), 0.0)));
}

}  // namespace
}  // namespace laparoscope_servo::servo
