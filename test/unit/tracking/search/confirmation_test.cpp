#include "tracking/search/confirmation.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {100, 80, 60, 60};  // its diagonal: 85 px

Evidence at(double x, int confident_blocks = 20) {
  Evidence found;
  found.roi = kRoi;
  found.esm.status = EsmStatus::kConverged;
  found.esm.state.g(0, 2) = x;
  found.esm.corner_error = 0.1;
  found.blocks.seen = 36;
  found.blocks.confident = confident_blocks;
  return found;
}

class ConfirmationTest : public ::testing::Test {
 protected:
  Confirmation confirmation_{QualityConfig()};  // three
  double stamp_ = 5.0;                          // s, of the next image
  bool add(const Evidence& found) {
    stamp_ += 0.04;
    return confirmation_.add(found, stamp_);
  }
  void miss() {
    stamp_ += 0.04;
    confirmation_.miss(stamp_);
  }
};

TEST_F(ConfirmationTest, TakesAsManyImagesAsAreAskedFor) {
  for (const int wanted : {1, 2, 5}) {
    QualityConfig config;
    config.confirmations = wanted;
    Confirmation confirmation(config);
    for (int k = 1; k < wanted; ++k) EXPECT_FALSE(confirmation.add(at(7.0), 0.04 * k)) << wanted;
    EXPECT_TRUE(confirmation.add(at(7.0), 0.04 * wanted)) << wanted;
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

TEST_F(ConfirmationTest, WaitsInImagesInWhichItIsNotFound) {
  add(at(0.0));
  for (int k = 0; k < 3; ++k) miss();
  add(at(10.0));
  EXPECT_NEAR(confirmation_.awaited()->g(0, 2), 10.0, 1e-12);  // how fast it moved is not known
  miss();
  EXPECT_TRUE(confirmation_.waiting());
  EXPECT_TRUE(add(at(12.0)));
}

TEST_F(ConfirmationTest, DoesNotWaitForLong) {
  add(at(0.0));
  add(at(0.0));
  for (int k = 0; k < 6; ++k) miss();  // 0.24 s
  EXPECT_FALSE(confirmation_.waiting());
  EXPECT_FALSE(add(at(0.0)));
}

TEST_F(ConfirmationTest, WhatWasMissedIsProvenByItsBlocks) {
  add(at(0.0, 3));
  add(at(0.0, 3));
  EXPECT_TRUE(confirmation_.justFound());
  miss();
  EXPECT_FALSE(confirmation_.justFound());
  EXPECT_FALSE(add(at(0.0, 3))) << "starts again";
  EXPECT_FALSE(add(at(0.0, 3)));
  miss();
  EXPECT_TRUE(add(at(0.0, 12)));
}

TEST_F(ConfirmationTest, WhatIsNotMissedNeedsNoMoreBlocks) {
  add(at(0.0, 3));
  add(at(0.0, 3));
  EXPECT_TRUE(add(at(0.0, 3)));
}

TEST_F(ConfirmationTest, DoesNotWaitElsewhere) {
  add(at(0.0));
  add(at(0.0));
  miss();
  EXPECT_FALSE(add(at(60.0)));
  EXPECT_FALSE(add(at(60.0)));
  EXPECT_TRUE(add(at(60.0)));
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
  const auto calmly = [&](double x) {
    Evidence found = at(x);
    found.record = calm;
    return found;
  };
  const double way = 0.1 * 85.0;
  Confirmation first(QualityConfig{});
  first.add(calmly(0.0), 0.0);
  first.add(calmly(way), 0.0);
  EXPECT_TRUE(first.add(calmly(2.0 * way), 0.0));
  Confirmation later(QualityConfig{});
  later.add(calmly(0.0), 0.0);
  later.add(calmly(0.0), 0.0);
  EXPECT_FALSE(later.add(calmly(way), 0.0));
}

TEST_F(ConfirmationTest, WhatHasNoImageIsNowhereNear) {
  add(at(0.0));
  add(at(0.0));
  Evidence through_infinity = at(0.0);
  through_infinity.esm.state.g(2, 0) = -1.0 / 130.0;
  EXPECT_FALSE(add(through_infinity));
}

}  // namespace
}  // namespace laparoscope_servo::tracking
