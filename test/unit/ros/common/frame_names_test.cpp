#include "ros/common/frame_names.h"

#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

TEST(FrameNames, ThePrefixIsTheNamespaceUnlessItIsGiven) {
  EXPECT_EQ(framePrefix("auto", "/"), "");
  EXPECT_EQ(framePrefix("auto", ""), "");
  EXPECT_EQ(framePrefix("auto", "/left"), "left/");
  EXPECT_EQ(framePrefix("auto", "/room/left/"), "room/left/");
  EXPECT_EQ(framePrefix("", "/left"), "");
  EXPECT_EQ(framePrefix("l_", "/left"), "l_");
}

TEST(FrameNames, AFrameWithASlashIsWhole) {
  EXPECT_EQ(prefixedFrame("left/", "scope_tip"), "left/scope_tip");
  EXPECT_EQ(prefixedFrame("", "scope_tip"), "scope_tip");
  EXPECT_EQ(prefixedFrame("left/", "right/scope_tip"), "right/scope_tip");
}

}  // namespace
}  // namespace laparoscope_servo
