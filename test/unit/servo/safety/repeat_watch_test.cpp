#include "servo/safety/repeat_watch.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::servo {
namespace {

TaskError seen(double x) {
  TaskError error;
  error.x = x;
  return error;
}

// An image every 40 ms.
class Camera {
 public:
  bool take(double x, bool moves) {
    watch.take(time_ += 0.04, seen(x), moves);
    return watch.repeats();
  }
  RepeatWatch watch{3};

 private:
  double time_ = 0.0;
};

TEST(RepeatWatch, ThirdRepetitionOfAMovingScopeTells) {
  Camera camera;
  EXPECT_FALSE(camera.take(0.1, true));
  EXPECT_FALSE(camera.take(0.1, true));
  EXPECT_FALSE(camera.take(0.1, true));
  EXPECT_TRUE(camera.take(0.1, true));
}

TEST(RepeatWatch, StandingStillRepeatsAsLongAsItLikes) {
  Camera camera;
  for (int k = 0; k < 100; ++k) EXPECT_FALSE(camera.take(0.1, false));
  EXPECT_FALSE(camera.take(0.1, true)) << "the repetitions before the motion do not count";
}

TEST(RepeatWatch, HoldsUntilSomethingElseIsSeen) {
  Camera camera;
  for (int k = 0; k < 4; ++k) camera.take(0.1, true);
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(camera.take(0.1, false));
  EXPECT_FALSE(camera.take(0.1 + 1e-15, false));
  for (int k = 0; k < 2; ++k) EXPECT_FALSE(camera.take(0.1 + 1e-15, true));
}

TEST(RepeatWatch, TheLastDigitIsEnough) {
  Camera camera;
  for (int k = 0; k < 100; ++k) EXPECT_FALSE(camera.take(0.1 + 1e-16 * k * 10, true));
}

TEST(RepeatWatch, FewRepetitionsBetweenPicturesAreAStutter) {
  Camera camera;
  for (int k = 0; k < 100; ++k) EXPECT_FALSE(camera.take(0.1 * (k / 3), true)) << k;
}

TEST(RepeatWatch, AMessageCountsOnce) {
  RepeatWatch watch(3);
  for (int k = 0; k < 100; ++k) watch.take(1.0, seen(0.1), true);
  EXPECT_FALSE(watch.repeats());
}

}  // namespace
}  // namespace laparoscope_servo::servo
