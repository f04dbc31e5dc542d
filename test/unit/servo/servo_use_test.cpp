#include "servo/servo_use.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::servo {
namespace {

// Other than the defaults in everything that a task may take from the configuration.
ControllerConfig unusual() {
  ControllerConfig config;
  config.law = LawKind::kPaper;
  config.spin = SpinMode::kUpright;
  config.rest.depth_stop = 0.011;
  config.rest.widening = 1.7;
  config.centre_tip.inner = 0.08;
  config.centre_tip.zone = 0.17;
  return config;
}

// The paper's law needs the numbers of a homography, which only the tracked region has.
TEST(ServoUse, OnlyTheRegionMayBeHeldByThePapersLaw) {
  for (const Task task : kTasks) {
    const bool is_region = task == Task::kHoldView || task == Task::kManual;
    EXPECT_EQ(servoUse(task, unusual()).law, is_region ? LawKind::kPaper : LawKind::kFeatures)
        << static_cast<int>(task);
  }
}

TEST(ServoUse, EachTaskHasItsDegreesOfFreedom) {
  for (const Task task : {Task::kHoldView, Task::kPoints, Task::kPosition}) {
    EXPECT_EQ(servoUse(task, unusual()).spin, SpinMode::kUpright) << static_cast<int>(task);
    EXPECT_TRUE(servoUse(task, unusual()).insertion) << static_cast<int>(task);
    EXPECT_TRUE(servoUse(task, unusual()).axes().spin);
  }
  for (const Task task : {Task::kCentreTip, Task::kFollow, Task::kParallel, Task::kStabilise}) {
    EXPECT_EQ(servoUse(task, unusual()).spin, SpinMode::kReleased) << static_cast<int>(task);
    EXPECT_FALSE(servoUse(task, unusual()).insertion) << static_cast<int>(task);
    EXPECT_FALSE(servoUse(task, unusual()).axes().spin);
    EXPECT_FALSE(servoUse(task, unusual()).axes().insertion);
  }
}

TEST(ServoUse, StabiliseTakesSpinAndInsertionOnChoiceEachByItself) {
  ControllerConfig config = unusual();
  config.stabilise.spin = true;
  EXPECT_EQ(servoUse(Task::kStabilise, config).spin, SpinMode::kUpright);
  EXPECT_FALSE(servoUse(Task::kStabilise, config).insertion);
  config.stabilise.spin = false;
  config.stabilise.insertion = true;
  EXPECT_EQ(servoUse(Task::kStabilise, config).spin, SpinMode::kReleased);
  EXPECT_TRUE(servoUse(Task::kStabilise, config).insertion);
}

// What a hand moves, and a goal that is at rest in the arm's base, are not predicted as tissue is.
TEST(ServoUse, TissueIsWhatIsFollowedAhead) {
  for (const Task task : kTasks) {
    const bool is_tissue = task != Task::kCentreTip && task != Task::kParallel;
    EXPECT_EQ(servoUse(task, unusual()).is_tissue, is_tissue) << static_cast<int>(task);
    EXPECT_EQ(servoUse(task, unusual()).rest.has_value(), !is_tissue) << static_cast<int>(task);
  }
}

// The zone is the band: it holds also where bands are switched off, and a tip that comes back does not make it grow.
TEST(ServoUse, TheZoneOfATipIsItsBandOfRest) {
  ControllerConfig config = unusual();
  config.rest.enabled = false;
  const ServoUse use = servoUse(Task::kCentreTip, config);
  ASSERT_TRUE(use.rest);
  EXPECT_TRUE(use.rest->enabled);
  EXPECT_EQ(use.rest->centre_stop, 0.08);
  EXPECT_EQ(use.rest->centre_start, 0.17);
  EXPECT_EQ(use.rest->widening, 1.0);
  EXPECT_EQ(use.rest->depth_stop, 0.011) << "the rest of it as it is configured";
}

// 0.05 degrees of noise, and a place in the image about two and a half times as far off as the axis is turned.
TEST(ServoUse, TheBandOfParallelLiesAboveTheNoiseOfPoses) {
  constexpr double kNoise = 2.5 * 0.05 * M_PI / 180.0;  // normalised
  const ServoUse use = servoUse(Task::kParallel, unusual());
  ASSERT_TRUE(use.rest);
  EXPECT_TRUE(use.rest->enabled);
  EXPECT_GT(use.rest->centre_stop, 1.5 * kNoise);
  EXPECT_GT(use.rest->centre_start, 2.0 * use.rest->centre_stop);
  EXPECT_LT(use.rest->centre_start, 2.5 * 0.3 * M_PI / 180.0) << "0.3 degrees";
  EXPECT_EQ(use.rest->widening, 1.7);
}

}  // namespace
}  // namespace laparoscope_servo::servo
