#include "servo/safety/usual_age.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace laparoscope_servo::servo {
namespace {

constexpr double kDelay = 0.03;  // s, from the exposure to its arrival

// A camera: one image after the other, each of which the controller hears of.
struct Camera {
  explicit Camera(double its_period) : period(its_period) {}

  void image(double stamped = 0.0) {
    time += period;
    age.take(time - kDelay - stamped, time);
    stamp = time - kDelay - stamped;
  }
  void images(int count) {
    for (int k = 0; k < count; ++k) image();
  }
  // Of the last image, when nothing has come for so long.
  double share(double silence) const { return age.share(time + silence - stamp); }

  UsualAge age;
  double period;
  double time = 10.0;
  double stamp = 0.0;
};

TEST(UsualAge, SaysNothingBeforeItKnowsTheCamera) {
  Camera camera(0.04);
  camera.images(8);
  EXPECT_EQ(camera.share(1.0), 1.0);
  camera.image();
  EXPECT_EQ(camera.share(1.0), 0.0);
  camera.age.restart();
  EXPECT_EQ(camera.share(1.0), 1.0);
}

// At any rate: full speed until the next image is due, none when it has not come a period later.
TEST(UsualAge, AnImageThatIsMissingSlowsDownAtOnce) {
  for (const double period : {1.0 / 60.0, 0.02, 0.04, 0.1, 0.2}) {
    Camera camera(period);
    camera.images(20);
    const double counted = std::max(period, 0.02);
    EXPECT_EQ(camera.share(0.0), 1.0) << period;
    EXPECT_EQ(camera.share(period), 1.0) << period;
    EXPECT_EQ(camera.share(period + 0.24 * counted), 1.0) << period;
    EXPECT_NEAR(camera.share(period + 0.75 * counted), 0.5, 1e-9) << period;
    EXPECT_EQ(camera.share(period + 1.26 * counted), 0.0) << period;
  }
}

TEST(UsualAge, OneThatIsLateNowAndThenChangesNothing) {
  Camera camera(0.04);
  camera.images(40);
  for (int k = 0; k < 100; ++k) {
    camera.image();
    if (k % 10 == 0) camera.time += 0.08;  // two are dropped
  }
  EXPECT_EQ(camera.share(0.045), 1.0);
  EXPECT_EQ(camera.share(0.1), 0.0);
}

// A loaded machine, or a grabber that stamps what it delivers: what is usual takes it in.
TEST(UsualAge, UnevenStampsAreUsual) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> late(0.0, 0.1);
  Camera camera(0.04);
  int slower = 0, images = 0;
  for (int k = 0; k < 400; ++k) {
    camera.image(late(random));
    if (k < 40) continue;
    ++images;
    if (camera.share(0.04) < 0.5) ++slower;
  }
  EXPECT_LT(slower, 0.05 * images);
}

// Stamps that go half as fast: each image is older than the one before, and what is usual does not catch up.
TEST(UsualAge, StampsThatLoseTimeAreNoticedWithinAFewImages) {
  for (const double period : {1.0 / 60.0, 0.04}) {
    Camera camera(period);
    camera.images(40);
    int images = 0;
    double lost = 0.0;
    for (; camera.share(period) > 0.0; ++images) {
      ASSERT_LT(images, 10) << period;
      camera.image(lost += 0.5 * period);
    }
    EXPECT_LE(images, 4) << period;
    while (lost < 0.8) {  // far beyond what is too old by any bound
      camera.image(lost += 0.5 * period);
      EXPECT_EQ(camera.share(period), 0.0) << period;
    }
  }
}

TEST(UsualAge, AfterAJumpOfAClockItBeginsAnew) {
  Camera camera(0.04);
  camera.images(40);
  camera.time += 100.0;
  camera.image();
  EXPECT_EQ(camera.share(0.5), 1.0);
  camera.images(40);
  EXPECT_EQ(camera.share(0.5), 0.0);
}

TEST(UsualAge, NumbersThatAreNoneChangeNothing) {
  Camera camera(0.04);
  camera.images(40);
  camera.age.take(std::nan(""), 20.0);
  camera.age.take(20.0, std::nan(""));
  EXPECT_EQ(camera.share(0.04), 1.0);
  EXPECT_EQ(camera.share(std::nan("")), 0.0);
}

}  // namespace
}  // namespace laparoscope_servo::servo
