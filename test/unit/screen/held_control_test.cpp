#include "screen/held_control.h"

#include <gtest/gtest.h>

#include <limits>

#include "screen/key_hold.h"

namespace laparoscope_servo::screen {
namespace {

TEST(HeldControl, IsHeldFromTakingToLettingGo) {
  HeldControl control;
  EXPECT_FALSE(control.isHeld(10.0));
  control.take(10.0);
  EXPECT_TRUE(control.isHeld(10.05));
  control.letGo();
  EXPECT_FALSE(control.isHeld(10.06));
}

TEST(HeldControl, ABeatKeepsIt) {
  HeldControl control;
  control.take(10.0);
  for (int k = 1; k <= 100; ++k) {
    control.beat(10.0 + 0.05 * k);
    EXPECT_TRUE(control.isHeld(10.0 + 0.05 * k + 0.04));
  }
}

TEST(HeldControl, AGuiThatHangsEndsItForGood) {
  HeldControl control;
  control.take(10.0);
  control.beat(10.1);
  EXPECT_TRUE(control.isHeld(10.1 + 0.9 * kPatience));
  EXPECT_FALSE(control.isHeld(10.1 + 1.1 * kPatience));
  control.beat(10.5);
  EXPECT_FALSE(control.isHeld(10.5)) << "the hand has to take it anew";
  control.take(10.6);
  EXPECT_TRUE(control.isHeld(10.6));
}

// Nobody asked while it hung.
TEST(HeldControl, ABeatAfterTheSilenceDoesNotBringItBack) {
  HeldControl control;
  control.take(10.0);
  control.beat(12.0);
  EXPECT_FALSE(control.isHeld(12.0));
}

TEST(HeldControl, AClockThatIsNoneEndsIt) {
  HeldControl control;
  control.take(10.0);
  EXPECT_FALSE(control.isHeld(std::numeric_limits<double>::quiet_NaN()));
}

TEST(KeyHold, IsHeldThroughX11sRepetition) {
  KeyHold key;
  EXPECT_TRUE(key.press());
  for (int k = 0; k < 50; ++k) {  // a pair each 40 ms
    key.release(10.0 + 0.04 * k);
    EXPECT_FALSE(key.press()) << "no new press";
    EXPECT_FALSE(key.released(10.0 + 0.04 * k + kRepeatGap)) << "the press has followed";
  }
  EXPECT_TRUE(key.isDown());
  key.release(20.0);
  EXPECT_FALSE(key.released(20.0 + 0.5 * kRepeatGap));
  EXPECT_TRUE(key.released(20.001 + kRepeatGap));
  EXPECT_FALSE(key.isDown());
  EXPECT_FALSE(key.released(21.0)) << "once";
  EXPECT_TRUE(key.press());
}

TEST(KeyHold, AReleaseOfAKeyThatIsNotDownIsNone) {
  KeyHold key;
  key.release(10.0);
  EXPECT_FALSE(key.released(11.0));
}

}  // namespace
}  // namespace laparoscope_servo::screen
