#include "laparoscope_servo/aesop/round_trips.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::aesop {
namespace {

TEST(RoundTrips, withoutAnyAllIsZero) {
  const RoundTripSummary summary = RoundTrips().summary();
  EXPECT_EQ(summary.count, 0u);
  EXPECT_EQ(summary.median, 0.0);
  EXPECT_EQ(summary.jitter, 0.0);
}

TEST(RoundTrips, oneIsAllOfThem) {
  RoundTrips trips;
  trips.add(0.02);
  const RoundTripSummary summary = trips.summary();
  EXPECT_EQ(summary.median, 0.02);
  EXPECT_EQ(summary.p99, 0.02);
  EXPECT_EQ(summary.longest, 0.02);
  EXPECT_EQ(summary.jitter, 0.0);
}

TEST(RoundTrips, ranksAmongAHundred) {
  RoundTrips trips;
  for (int k = 100; k >= 1; --k) trips.add(0.001 * k);
  const RoundTripSummary summary = trips.summary();
  EXPECT_EQ(summary.count, 100u);
  EXPECT_NEAR(summary.median, 0.050, 1e-12);
  EXPECT_NEAR(summary.p99, 0.099, 1e-12);
  EXPECT_NEAR(summary.longest, 0.100, 1e-12);
  EXPECT_NEAR(summary.jitter, 0.001, 1e-12);
}

TEST(RoundTrips, onlyTheNewestCount) {
  RoundTrips trips(10);
  for (int k = 0; k < 1000; ++k) trips.add(1.0);
  for (int k = 0; k < 13; ++k) trips.add(k % 2 == 0 ? 0.010 : 0.012);
  const RoundTripSummary summary = trips.summary();
  EXPECT_EQ(summary.count, 10u);
  EXPECT_EQ(summary.longest, 0.012);
  EXPECT_NEAR(summary.jitter, 0.002, 1e-12) << "in the order in which they came, across the end of the ring";
  trips.clear();
  EXPECT_EQ(trips.summary().count, 0u);
}

}  // namespace
}  // namespace laparoscope_servo::aesop
