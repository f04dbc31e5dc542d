#include "servo/safety/stamp_scatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace laparoscope_servo::servo {
namespace {

using Features = StampScatter::Features;

constexpr double kStep = 0.04;     // s
constexpr double kNoise = 0.0005;  // normalised
const Features kVariance = Features(kNoise, kNoise, 0.003, 0.003).cwiseAbs2();

// A picture that goes along x at `speed`, seen at times that are off by up to `off` [s]. One explanation leaves nothing
// over but what the stamps make, the other all.
struct Feed {
  void run(int images, double speed, double off) {
    std::uniform_real_distribution<double> scatter(0.0, 1.0);
    std::normal_distribution<double> noise(0.0, kNoise);
    for (int k = 0; k < images; ++k) {
      time += kStep;
      place += kStep * speed;
      const double seen = place - off * scatter(random) * speed + noise(random);
      const Features all(seen, noise(random), 0.0, 0.0);
      stamps.take(time, all, {all - Features(place, 0.0, 0.0, 0.0), all}, kVariance, Features::Zero());
    }
  }
  StampScatter stamps;
  double time = 0.0;
  double place = 0.0;

 private:
  std::mt19937 random{3};
};

TEST(StampScatter, IsMeasuredOnceThePictureMoves) {
  Feed feed;
  feed.run(100, 0.0, 0.1);
  const double before = feed.stamps.seconds();
  EXPECT_LT(before, 0.011) << "nothing is known yet";
  EXPECT_GT(before, 0.005);
  feed.run(50, 0.2, 0.1);
  EXPECT_NEAR(feed.stamps.seconds(), 0.1 / std::sqrt(12.0), 0.008);
  EXPECT_NEAR(feed.stamps.speed()[0], 0.2, 0.08);
}

TEST(StampScatter, IsSmallWhereStampsAreTrue) {
  Feed feed;
  feed.run(20, 0.4, 0.0);
  EXPECT_LT(feed.stamps.seconds(), 0.006);
  feed.run(40, 0.4, 0.0);
  EXPECT_LT(feed.stamps.seconds(), 0.004);
}

// What grows is no scatter: the explanation that does not know of the motion is no rougher than the other.
TEST(StampScatter, IsNotAMotionThatNoExplanationKnows) {
  StampScatter stamps;
  for (int k = 0; k < 100; ++k) {
    const double t = kStep * k;
    const Features seen(0.2 * std::sin(2.0 * t), 0.0, 0.0, 0.0);
    stamps.take(t + 1.0, seen, {seen}, kVariance, Features::Zero());
  }
  EXPECT_LT(stamps.seconds(), 0.004);
}

// Another picture in the place of this one, for an image or for good, tells nothing of the stamps.
TEST(StampScatter, IsNotAPictureThatIsElsewhere) {
  Feed feed;
  feed.run(60, 0.2, 0.0);
  feed.place += 0.3;
  feed.run(1, 0.2, 0.0);
  feed.place -= 0.3;
  feed.run(3, 0.2, 0.0);
  EXPECT_LT(feed.stamps.seconds(), 0.02);
}

TEST(StampScatter, IsBoundedAndSurvivesNumbersThatAreNone) {
  Feed feed;
  feed.run(100, 0.4, 0.4);
  EXPECT_LE(feed.stamps.seconds(), 0.06);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Features none = Features::Constant(nan);
  feed.time += kStep;
  feed.stamps.take(feed.time, none, {none, none}, kVariance, none);
  feed.stamps.restart();
  feed.run(100, 0.2, 0.0);
  EXPECT_TRUE(std::isfinite(feed.stamps.seconds()));
  EXPECT_LT(feed.stamps.seconds(), 0.06);
}

}  // namespace
}  // namespace laparoscope_servo::servo
