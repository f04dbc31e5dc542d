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
  WireDirection line(1, 0);
  line.faults = faults;
  Bytes bytes;
  for (const std::uint8_t byte : numbers()) {
    line.push({byte}, 0.0);
    const Bytes come = line.pop(0.0);
    bytes.insert(bytes.end(), come.begin(), come.end());
  }
  return bytes;
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
  WireDirection line(1, 0);
  line.faults.delay = 1.0;
  line.push({1}, 0.0);
  line.faults.delay = 0.0;
  line.push({2}, 0.5);
  EXPECT_TRUE(line.pop(0.9).empty());
  EXPECT_EQ(line.next(), 1.0);
  EXPECT_EQ(line.pop(1.0), (Bytes{1, 2}));
}

TEST(Wire, aByteTakesTenBits) {
  WireDirection line(1, 1000);
  line.push({1, 2}, 5.0);
  EXPECT_NEAR(line.next(), 5.01, 1e-12);
  EXPECT_TRUE(line.pop(5.009).empty());
  EXPECT_EQ(line.pop(5.011), Bytes{1});
  line.push({3}, 5.012);
  EXPECT_EQ(line.pop(5.021), Bytes{2}) << "the third waits until the second has left";
  EXPECT_EQ(line.pop(5.031), Bytes{3});
  line.push({4}, 7.0);
  EXPECT_NEAR(line.next(), 7.01, 1e-12) << "a pause is not made up for";
}

TEST(Wire, bytesThatGetLostOrComeTwiceTakeTheirTime) {
  WireDirection line(1, 1000);
  line.faults.drop = 1.0;
  line.push({1, 2}, 0.0);
  line.faults = WireFaults();
  line.faults.duplicate = 1.0;
  line.push({3}, 0.0);
  EXPECT_NEAR(line.next(), 0.03, 1e-12);
  EXPECT_EQ(line.pop(0.0301), Bytes{3});
  EXPECT_EQ(line.pop(0.0401), Bytes{3});
}

TEST(Wire, stalledBytesComeTogether) {
  WireDirection line(1, 0);
  line.push({1}, 0.0);
  line.faults.stalled_until = 2.0;
  line.push({2}, 1.0);
  EXPECT_TRUE(line.pop(1.9).empty());
  EXPECT_EQ(line.next(), 2.0);
  EXPECT_EQ(line.pop(2.0), (Bytes{1, 2}));
}

TEST(Wire, whatTheLineCannotHoldIsLost) {
  WireDirection line(1, 1200);
  for (int k = 0; k < 10; ++k) line.push(numbers(), 0.0);
  EXPECT_LT(line.pop(1e6).size(), 5000u);
  line.push({1}, 1e6);
  EXPECT_EQ(line.pop(2e6), Bytes{1});
}

TEST(Wire, cutForATimeOrUntilItComesBack) {
  Wire wire(1);
  EXPECT_FALSE(wire.isCut(0.0));
  wire.to_host.push({1}, 10.0);
  wire.cut(12.0);
  EXPECT_TRUE(wire.isCut(11.9));
  EXPECT_FALSE(wire.isCut(12.1));
  EXPECT_TRUE(wire.to_host.pop(13.0).empty()) << "what was under way is gone";
  wire.cut(std::numeric_limits<double>::infinity());
  EXPECT_TRUE(wire.isCut(1e6));
  wire.cut(30.0);
  EXPECT_FALSE(wire.isCut(30.0));
}

}  // namespace
}  // namespace laparoscope_servo::sim
