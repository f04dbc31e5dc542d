#include "servo/task/tip_stillness.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::servo {
namespace {

TEST(TipStillness, IsStillAfterTheDwellWithinOnePlace) {
  TipStillness tip(0.5, 0.02);
  EXPECT_FALSE(tip.isStill()) << "nothing was seen";
  for (int k = 0; k <= 12; ++k) {
    tip.see(10.0 + 0.04 * k, {0.3 + 0.001 * k, -0.1});
    EXPECT_FALSE(tip.isStill()) << k;
  }
  tip.see(10.52, {0.3, -0.1});
  EXPECT_TRUE(tip.isStill());
  tip.see(10.56, {0.3, -0.13});
  EXPECT_FALSE(tip.isStill()) << "it was moved";
}

TEST(TipStillness, ASlowTipIsNotStill) {
  TipStillness tip(0.5, 0.02);
  for (int k = 0; k < 200; ++k) {
    tip.see(0.04 * k, {0.05 * 0.04 * k, 0.0});  // 0.025 in a dwell
    EXPECT_FALSE(tip.isStill()) << k;
  }
}

TEST(TipStillness, BeginsAnew) {
  const auto still = [] {
    TipStillness tip(0.5, 0.02);
    for (int k = 0; k <= 20; ++k) tip.see(0.04 * k, {0.3, 0.0});
    EXPECT_TRUE(tip.isStill());
    return tip;
  };
  TipStillness restarted = still();
  restarted.restart();
  EXPECT_FALSE(restarted.isStill());
  TipStillness back = still();
  back.see(0.1, {0.3, 0.0});
  EXPECT_FALSE(back.isStill()) << "time went back";
  TipStillness nowhere = still();
  nowhere.see(0.84, {std::nan(""), 0.0});
  EXPECT_FALSE(nowhere.isStill());
  TipStillness timeless = still();
  timeless.see(std::nan(""), {0.3, 0.0});
  EXPECT_FALSE(timeless.isStill());
}

}  // namespace
}  // namespace laparoscope_servo::servo
