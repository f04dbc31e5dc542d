#include "screen/minute_history.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::screen {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

TEST(MinuteHistory, KeepsTheLeastAndTheGreatestOfEachStep) {
  MinuteHistory history;
  history.add(100.1, true, 0.9, 0.3, 1.0, 0.02);
  history.add(100.2, false, 0.5, 0.8, 0.4, 0.05);
  history.add(100.6, true, 0.7, 0.1, 0.9, kNothing);
  const auto steps = history.steps(101.2);
  ASSERT_EQ(steps.size(), static_cast<std::size_t>(MinuteHistory::kSteps));
  const auto& first = steps[steps.size() - 3];
  EXPECT_EQ(first.ranges[kConfidence].low, 0.5);
  EXPECT_EQ(first.ranges[kConfidence].high, 0.9);
  EXPECT_EQ(first.ranges[kCornerError].high, 0.8);
  EXPECT_EQ(first.ranges[kRate].high, 4.0) << "two images in half a second";
  EXPECT_FALSE(first.tracked);
  EXPECT_TRUE(steps[steps.size() - 2].tracked);
  EXPECT_FALSE(steps[steps.size() - 2].ranges[kDelay].known) << "NaN is not known";
  EXPECT_FALSE(steps.back().ranges[kRate].known) << "the last step is not over";
}

TEST(MinuteHistory, ForgetsWhatIsOlderThanAMinute) {
  MinuteHistory history;
  for (int k = 0; k < 1000; ++k) history.add(0.1 * k, true, 0.9, 0.1, 1.0, 0.01);
  EXPECT_TRUE(history.steps(100.0).front().ranges[kConfidence].known);
  EXPECT_EQ(history.steps(130.0).back().images, 0);
  EXPECT_EQ(history.steps(130.0)[80].ranges[kRate].high, 0.0) << "a camera that has stopped has the rate 0";
  for (const auto& step : history.steps(200.0)) EXPECT_EQ(step.images, 0);
}

}  // namespace
}  // namespace laparoscope_servo::screen
