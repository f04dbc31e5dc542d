#include "servo/safety/reported_motion.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::servo {
namespace {

constexpr double kLife = 0.25;

scope::Velocity pan(double velocity) {
  return {velocity, 0.0, 0.0, 0.0};
}

double panned(const ReportedMotion& motion, double begin, double end) {
  return motion.displacement(begin, end)[0];
}

TEST(ReportedMotion, NothingIsKnownBeforeAReportAndAfterItsLife) {
  ReportedMotion motion(3.0, kLife);
  EXPECT_EQ(panned(motion, 0.0, 10.0), 0.0);
  motion.add(1.0, pan(0.1));
  EXPECT_EQ(panned(motion, 0.0, 1.0), 0.0);
  EXPECT_NEAR(panned(motion, 0.0, 10.0), 0.1 * kLife, 1e-12);
  motion.add(2.0, pan(0.2));
  EXPECT_NEAR(panned(motion, 0.0, 10.0), 0.3 * kLife, 1e-12) << "too far apart for a line between them";
}

// A scope that gets going evenly is where the reports say, however few of them come.
TEST(ReportedMotion, BetweenTwoReportsTheVelocityGoesInAStraightLine) {
  for (const double period : {0.02, 0.1, 0.2}) {
    ReportedMotion motion(3.0, kLife);
    for (double time = 0.0; time < 1.01; time += period) motion.add(time, pan(0.1 * time));
    EXPECT_NEAR(panned(motion, 0.0, 1.0), 0.05, 1e-12) << period;
    EXPECT_NEAR(panned(motion, 0.33, 0.47), 0.05 * (0.47 * 0.47 - 0.33 * 0.33), 1e-12) << period;
    EXPECT_EQ(panned(motion, 0.5, 0.5), 0.0);
    EXPECT_NEAR(panned(motion, 0.0, 0.37) + panned(motion, 0.37, 1.0), panned(motion, 0.0, 1.0), 1e-12) << period;
  }
}

TEST(ReportedMotion, OneThatIsOlderThanTheLastBeginsAnew) {
  ReportedMotion motion(3.0, kLife);
  motion.add(1.0, pan(0.1));
  motion.add(1.0, pan(0.2));
  EXPECT_NEAR(panned(motion, 0.0, 10.0), 0.2 * kLife, 1e-12) << "of two of one time the later counts";
  motion.add(0.5, pan(0.3));
  EXPECT_NEAR(panned(motion, 0.0, 10.0), 0.3 * kLife, 1e-12);
}

TEST(ReportedMotion, KeepsWhatStoodForTheMotionInTheSpan) {
  ReportedMotion motion(1.0, kLife);
  for (int k = 0; k <= 100; ++k) motion.add(0.1 * k, pan(0.1));
  EXPECT_NEAR(panned(motion, 9.0, 10.0), 0.1, 1e-12);
  EXPECT_EQ(panned(motion, 0.0, 8.0), 0.0) << "forgotten";
}

}  // namespace
}  // namespace laparoscope_servo::servo
