#include "ros/tracker/feed_owner.h"

#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

TEST(FeedOwnerTest, TakesTheFirstUntilItFallsSilent) {
  FeedOwner owner;
  EXPECT_TRUE(owner.counts("/camera", 10.0));
  EXPECT_EQ(owner.complaint(10.0), "");
  for (int k = 1; k <= 50; ++k) {
    EXPECT_FALSE(owner.counts("/other", 10.0 + 0.04 * k));
    EXPECT_TRUE(owner.counts("/camera", 10.02 + 0.04 * k));
  }
  EXPECT_EQ(owner.refused(), 50u);
  EXPECT_EQ(owner.complaint(12.1), "those of /other are refused, /camera sent first");
  EXPECT_FALSE(owner.counts("/other", 13.9));
  EXPECT_TRUE(owner.counts("/other", 14.1)) << "the owner was silent for longer than 2 s";
  EXPECT_EQ(owner.owner(), "/other");
  EXPECT_EQ(owner.complaint(20.0), "");
}

TEST(FeedOwnerTest, ShowsNoNameThatIsNone) {
  FeedOwner owner;
  owner.counts("/camera", 1.0);
  owner.counts("not a name\n", 1.1);
  EXPECT_EQ(owner.complaint(1.1).find('\n'), std::string::npos);
}

}  // namespace
}  // namespace laparoscope_servo
