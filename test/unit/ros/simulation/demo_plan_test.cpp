#include "ros/simulation/demo_plan.h"

#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

TEST(DemoPlan, TellsWhichStepHowLongItTakesAndHowLongAllOfItStillTakes) {
  const std::vector<DemoStep> steps{{"first", 2.0}, {"second", 3.4}};
  EXPECT_EQ(announcement(steps, 0), "step 1 of 2: first (about 2 s; about 5 s left)");
  EXPECT_EQ(announcement(steps, 1), "step 2 of 2: second (about 3 s; about 3 s left)");
}

TEST(DemoPlan, SaysASecondWhereAStepTakesLess) {
  EXPECT_EQ(announcement({{"short", 0.1}}, 0), "step 1 of 1: short (about 1 s; about 1 s left)");
}

TEST(DemoPlan, FollowsTheParametersAndNamesTheInstrumentOnlyWhereItCrosses) {
  const std::vector<DemoStep> steps = demoSteps(6.0, 2.0, true);
  ASSERT_EQ(steps.size(), kDemoInstrument + 1);
  EXPECT_EQ(steps[kDemoHand].expected, 6.0);
  EXPECT_NE(steps[kDemoInstrument].what.find("instrument"), std::string::npos);
  EXPECT_EQ(demoSteps(6.0, 2.0, false).size(), std::size_t{kDemoInstrument});
  EXPECT_EQ(demoSteps(6.0, 7.0, true)[kDemoLoop].expected, steps[kDemoLoop].expected + 5.0);
}

}  // namespace
}  // namespace laparoscope_servo
