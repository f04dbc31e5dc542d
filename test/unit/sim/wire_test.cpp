#include "laparoscope_servo/sim/wire.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::sim {
namespace {

using aesop::Bytes;

Bytes numbers() {
  Bytes bytes;
  for (int k = 0; k < 10000; ++k) bytes.push_back(static_cast<std::uint8_t>(k));
  return bytes;
}

Bytes through(const WireFaults& faults) {
  WireDirection line(1);
  line.push(numbers(), faults, 0.0);
  return line.pop(0.0);
}

WireFaults faults(double drop, double corrupt, double duplicate) {
  WireFaults result;
  result.drop = drop;
  result.corrupt = corrupt;
  result.duplicate = duplicate;
  return result;
}

TEST(Wire, aGoodLineChangesNothing) {
  EXPECT_EQ(through(WireFaults()), numbers());
}

TEST(Wire, faultsHitAboutAsOftenAsAsked) {
  EXPECT_NEAR(static_cast<double>(through(faults(0.1, 0, 0)).size()), 9000.0, 150.0);
  EXPECT_NEAR(static_cast<double>(through(faults(0, 0, 0.1)).size()), 11000.0, 150.0);
  const Bytes corrupted = through(faults(0, 0.1, 0));
  ASSERT_EQ(corrupted.size(), 10000u);
  int changed = 0;
  for (std::size_t k = 0; k < corrupted.size(); ++k) {
    const int difference = corrupted[k] ^ numbers()[k];
    changed += difference != 0 ? 1 : 0;
    EXPECT_EQ(difference & (difference - 1), 0) << "one bit at a time";
    if (changed > 1200) break;
  }
  EXPECT_NEAR(changed, 1000, 150);
  EXPECT_TRUE(through(faults(1, 0, 0)).empty());
}

TEST(Wire, sameSeedSameFaults) {
  EXPECT_EQ(through(faults(0.1, 0.1, 0.1)), through(faults(0.1, 0.1, 0.1)));
}

TEST(Wire, delayKeepsTheOrderAlsoWhenItShrinks) {
  WireDirection line(1);
  WireFaults slow;
  slow.delay = 1.0;
  line.push({1}, slow, 0.0);
  line.push({2}, WireFaults(), 0.5);
  EXPECT_TRUE(line.pop(0.9).empty());
  EXPECT_EQ(line.pop(1.0), (Bytes{1, 2}));
}

TEST(Wire, faultsByName) {
  Wire wire(1);
  EXPECT_EQ(wire.set("drop", 0.1, 0.0), "");
  EXPECT_EQ(wire.set("corrupt", 0.2, 0.0), "");
  EXPECT_EQ(wire.set("double", 0.3, 0.0), "");
  EXPECT_EQ(wire.set("delay", 0.4, 0.0), "");
  EXPECT_EQ(wire.faults.drop, 0.1);
  EXPECT_EQ(wire.faults.corrupt, 0.2);
  EXPECT_EQ(wire.faults.duplicate, 0.3);
  EXPECT_EQ(wire.faults.delay, 0.4);
  for (const double bad : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_NE(wire.set("drop", bad, 0.0), "");
  EXPECT_NE(wire.set("delay", -1.0, 0.0), "");
  EXPECT_NE(wire.set("hangup", -1.0, 0.0), "");
  EXPECT_NE(wire.set("rust", 1.0, 0.0), "");
  EXPECT_EQ(wire.set("none", 0.0, 0.0), "");
  EXPECT_EQ(wire.faults.drop, 0.0);
}

TEST(Wire, hangupForATimeOrUntilReturn) {
  Wire wire(1);
  EXPECT_FALSE(wire.isCut(0.0));
  wire.set("hangup", 2.0, 10.0);
  EXPECT_TRUE(wire.isCut(11.9));
  EXPECT_FALSE(wire.isCut(12.1));
  wire.set("hangup", 0.0, 20.0);
  EXPECT_TRUE(wire.isCut(1e6));
  wire.set("return", 0.0, 30.0);
  EXPECT_FALSE(wire.isCut(30.0));
}

}  // namespace
}  // namespace laparoscope_servo::sim
