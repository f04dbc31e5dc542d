#include "ros/common/stamp_gate.h"

#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

using Verdict = StampGate::Verdict;

// Images every 40 ms that arrive 50 ms after they were taken.
class Stream {
 public:
  Verdict take(double stamp) { return gate.judge(ros::Time(stamp), ros::Time(now)); }
  Verdict next(double offset = 0.0) {
    now += 0.04;
    return take(now - 0.05 + offset);
  }
  StampGate gate{0.1};
  double now = 1000.0;
};

TEST(StampGate, AStreamCounts) {
  Stream stream;
  for (int k = 0; k < 100; ++k) EXPECT_EQ(stream.next(0.01 * (k % 2)), Verdict::kCounts) << "jitter keeps the order";
}

TEST(StampGate, OutliersAreLeftOutAndChangeNothing) {
  struct Outlier {
    double stamp;
    Verdict verdict;
  };
  Stream stream;
  for (int k = 0; k < 20; ++k) {
    ASSERT_EQ(stream.next(), Verdict::kCounts);
    const double last = stream.now - 0.05;
    for (const Outlier& one :
         {Outlier{0.0, Verdict::kUnset}, Outlier{last, Verdict::kRepeated}, Outlier{last - 0.005, Verdict::kLate},
          Outlier{last - 0.1, Verdict::kLate}, Outlier{last - 50.0, Verdict::kLate},
          Outlier{stream.now + 0.11, Verdict::kAhead}, Outlier{stream.now + 1e6, Verdict::kAhead}}) {
      EXPECT_EQ(stream.take(one.stamp), one.verdict) << one.stamp;
    }
  }
  EXPECT_EQ(stream.next(), Verdict::kCounts);
  EXPECT_EQ(stream.gate.unset(), 20u);
  EXPECT_EQ(stream.gate.repeated(), 20u);
  EXPECT_EQ(stream.gate.late(), 60u);
  EXPECT_EQ(stream.gate.ahead(), 40u);
}

TEST(StampGate, ALittleAheadCounts) {
  Stream stream;
  EXPECT_EQ(stream.take(1000.09), Verdict::kCounts);
  EXPECT_EQ(stream.take(1000.11), Verdict::kAhead);
}

// Within what clocks may differ by, out of order for ever is still out of order.
TEST(StampGate, JitterIsNoJump) {
  Stream stream;
  stream.next();
  const double newest = stream.now - 0.05;
  for (int k = 0; k < 20; ++k) EXPECT_EQ(stream.take(newest - 0.09 + 0.004 * k), Verdict::kLate);
}

TEST(StampGate, AStreamThatStaysBehindHasBegunAnew) {
  Stream stream;
  for (int k = 0; k < 5; ++k) stream.next();
  EXPECT_EQ(stream.next(-1.0), Verdict::kLate);
  EXPECT_EQ(stream.next(-1.0), Verdict::kLate);
  EXPECT_EQ(stream.next(-1.0), Verdict::kJumpedBack);
  EXPECT_EQ(stream.next(-1.0), Verdict::kCounts);
}

TEST(StampGate, OldImagesAmongNewOnesAreNoJump) {
  Stream stream;
  for (int k = 0; k < 50; ++k) {
    EXPECT_EQ(stream.next(), Verdict::kCounts);
    EXPECT_EQ(stream.next(-1.0), Verdict::kLate);
    EXPECT_EQ(stream.next(-1.0), Verdict::kLate);
  }
}

TEST(StampGate, TheSameOldImageAgainIsNoJump) {
  Stream stream;
  stream.next();
  for (int k = 0; k < 20; ++k) EXPECT_EQ(stream.take(900.0), Verdict::kLate);
}

TEST(StampGate, TellsWhenNothingElseComes) {
  Stream stream;
  stream.next();
  for (int k = 0; k < 3; ++k) {
    EXPECT_FALSE(stream.gate.onlyAhead());
    stream.next(2.0);
  }
  EXPECT_TRUE(stream.gate.onlyAhead());
  EXPECT_FALSE(stream.gate.onlyUnset());
  stream.next();
  EXPECT_FALSE(stream.gate.onlyAhead());
  for (int k = 0; k < 3; ++k) stream.take(0.0);
  EXPECT_TRUE(stream.gate.onlyUnset());
}

TEST(StampGate, ClearForgets) {
  Stream stream;
  stream.next();
  stream.gate.clear();
  EXPECT_EQ(stream.take(50.0), Verdict::kCounts);
}

}  // namespace
}  // namespace laparoscope_servo
