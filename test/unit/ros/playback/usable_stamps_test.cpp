#include "ros/playback/usable_stamps.h"

#include <gtest/gtest.h>

#include <vector>

namespace laparoscope_servo {
namespace {

constexpr double kNone = 0.0;

// Recorded at 100, 100.1, ...
std::vector<double> usable(UsableStamps& stamps, const std::vector<double>& given) {
  std::vector<double> result;
  double recorded = 100.0;
  for (const double stamp : given) {
    result.push_back(stamps.of(ros::Time(stamp), ros::Time(recorded)).toSec());
    recorded += 0.1;
  }
  return result;
}

void expectNear(const std::vector<double>& got, const std::vector<double>& wanted) {
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t k = 0; k < got.size(); ++k) EXPECT_NEAR(got[k], wanted[k], 1e-6) << k;
}

TEST(UsableStamps, GoodOnesStayAlsoWhenTheyGoBack) {
  UsableStamps stamps;
  expectNear(usable(stamps, {50.0, 50.1, 49.0, 70.0}), {50.0, 50.1, 49.0, 70.0});
  EXPECT_EQ(stamps.replaced(), 0u);
}

TEST(UsableStamps, WithoutAnyStampTheTimeOfRecordingStandsForIt) {
  UsableStamps stamps;
  expectNear(usable(stamps, {kNone, kNone, kNone}), {100.0, 100.1, 100.2});
  EXPECT_EQ(stamps.replaced(), 3u);
}

TEST(UsableStamps, MissingAndRepeatedOnesFitIntoTheOthers) {
  UsableStamps stamps;
  expectNear(usable(stamps, {50.0, kNone, 50.2, 50.2, 50.2, 50.5}), {50.0, 50.1, 50.2, 50.3, 50.4, 50.5});
  EXPECT_EQ(stamps.replaced(), 3u);
}

TEST(UsableStamps, AtTheBeginningTheyFitToTheFirstThatIsThere) {
  UsableStamps stamps;
  stamps.learn(ros::Time(7.2), ros::Time(100.2));
  expectNear(usable(stamps, {kNone, kNone, 7.2}), {7.0, 7.1, 7.2});
  // One that begins at 0, which is no fault.
  UsableStamps simulated;
  simulated.learn(ros::Time(0.1), ros::Time(100.1));
  expectNear(usable(simulated, {0.0, 0.1, 0.2}), {0.0, 0.1, 0.2});
  EXPECT_EQ(simulated.replaced(), 0u);
}

TEST(UsableStamps, NoTwoInARowAreTheSame) {
  UsableStamps stamps;
  const ros::Time recorded(100.0);
  const ros::Time first = stamps.of(ros::Time(), recorded);
  EXPECT_GT(stamps.of(ros::Time(), recorded), first);
}

}  // namespace
}  // namespace laparoscope_servo
