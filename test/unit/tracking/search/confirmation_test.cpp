#include "tracking/search/confirmation.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {100, 80, 60, 60};  // its diagonal: 85 px

EsmResult at(double x, double corner_error = 0.1) {
  EsmResult result;
  result.status = EsmStatus::kConverged;
  result.state.g(0, 2) = x;
  result.corner_error = corner_error;
  return result;
}

class ConfirmationTest : public ::testing::Test {
 protected:
  Confirmation confirmation_{QualityConfig()};  // three in a row
  bool add(const EsmResult& found) { return confirmation_.add(found, kRoi, TrackRecord()); }
};

TEST_F(ConfirmationTest, TakesAsManyImagesAsAreAskedFor) {
  for (const int wanted : {1, 2, 5}) {
    QualityConfig config;
    config.confirmations = wanted;
    Confirmation confirmation(config);
    for (int k = 1; k < wanted; ++k) EXPECT_FALSE(confirmation.add(at(7.0), kRoi, TrackRecord())) << wanted;
    EXPECT_TRUE(confirmation.add(at(7.0), kRoi, TrackRecord())) << wanted;
  }
}

TEST_F(ConfirmationTest, WaitsWithWhatWasFoundLast) {
  EXPECT_FALSE(confirmation_.waiting());
  EXPECT_FALSE(confirmation_.awaited());
  add(at(3.0));
  EXPECT_TRUE(confirmation_.waiting());
  EXPECT_EQ(confirmation_.candidate().g(0, 2), 3.0);
  confirmation_.forget();
  EXPECT_FALSE(confirmation_.waiting());
}

TEST_F(ConfirmationTest, ExpectsItToGoOnAsItWent) {
  add(at(0.0));
  EXPECT_NEAR(confirmation_.awaited()->g(0, 2), 0.0, 1e-12);
  add(at(10.0));
  EXPECT_NEAR(confirmation_.awaited()->g(0, 2), 20.0, 1e-9);
  EXPECT_NEAR(confirmation_.awaited()->g.determinant(), 1.0, 1e-12);
  EXPECT_TRUE(add(at(20.0)));
}

// A new record allows 19 px.
TEST_F(ConfirmationTest, WhatIsElsewhereStartsAgain) {
  add(at(0.0));
  add(at(60.0));
  EXPECT_TRUE(confirmation_.waiting());
  EXPECT_NEAR(confirmation_.awaited()->g(0, 2), 60.0, 1e-9);  // its motion is not known again
  EXPECT_FALSE(add(at(60.0)));
  EXPECT_TRUE(add(at(60.0)));
}

TEST_F(ConfirmationTest, AFurtherWayIsAllowedWhileTheMotionIsNotKnown) {
  TrackRecord calm;
  for (int k = 0; k < 200; ++k) calm.add(0.9, 3.0, 0.0, 1.0, 0.04);
  const double way = 0.1 * 85.0;
  Confirmation first(QualityConfig{});
  first.add(at(0.0), kRoi, calm);
  first.add(at(way), kRoi, calm);
  EXPECT_TRUE(first.add(at(2.0 * way), kRoi, calm));
  Confirmation later(QualityConfig{});
  later.add(at(0.0), kRoi, calm);
  later.add(at(0.0), kRoi, calm);
  EXPECT_FALSE(later.add(at(way), kRoi, calm));
}

TEST_F(ConfirmationTest, WhatHasNoImageIsNowhereNear) {
  add(at(0.0));
  add(at(0.0));
  EsmResult through_infinity = at(0.0);
  through_infinity.state.g(2, 0) = -1.0 / 130.0;
  EXPECT_FALSE(add(through_infinity));
}

}  // namespace
}  // namespace laparoscope_servo::tracking
