#include "laparoscope_servo/parameters/nearest_name.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::parameters {
namespace {

const std::set<std::string> kKnown{"gains/pan", "limits/acceleration", "limits/velocity", "rate"};

TEST(NearestName, IsASlipAwayOrTheSameInAnotherGroup) {
  EXPECT_EQ(nearestName(kKnown, "limits/velocty"), "limits/velocity");
  EXPECT_EQ(nearestName(kKnown, "rte"), "rate");
  EXPECT_EQ(nearestName(kKnown, "velocity"), "limits/velocity");
  EXPECT_EQ(nearestName(kKnown, "law/gains/pan"), "gains/pan");
}

TEST(NearestName, IsNothingForWhatIsLikeNothing) {
  EXPECT_EQ(nearestName(kKnown, "colour_of_the_cart"), "");
  EXPECT_EQ(nearestName(kKnown, ""), "");
  EXPECT_EQ(nearestName({}, "rate"), "");
}

}  // namespace
}  // namespace laparoscope_servo::parameters
