#include "laparoscope_servo/validation/range.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace laparoscope_servo::validation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Range, HoldsTheEndsThatItIsWrittenWith) {
  const Range closed(0.0, 1.0);
  EXPECT_TRUE(closed.contains(0.0) && closed.contains(1.0));
  EXPECT_FALSE(closed.contains(-1e-9) || closed.contains(1.0 + 1e-9));
  EXPECT_EQ(closed.text(), "[0, 1]");
  const Range above = Range::above(0.0, 1.0);
  EXPECT_TRUE(above.contains(1e-9) && above.contains(1.0));
  EXPECT_FALSE(above.contains(0.0));
  EXPECT_EQ(above.text(), "(0, 1]");
  const Range between = Range::between(-0.5, 0.1);
  EXPECT_FALSE(between.contains(-0.5) || between.contains(0.1));
  EXPECT_EQ(between.text(), "(-0.5, 0.1)");
}

TEST(Range, HoldsNoNaNAndWhereItIsFiniteNoInfinity) {
  for (const Range& range : {Range(-kInfinity, kInfinity), Range(0.0, 1.0), Range::above(0.0, 1.0), Range::finite()})
    EXPECT_FALSE(range.contains(std::nan(""))) << range.text();
  EXPECT_FALSE(Range::finite().contains(kInfinity) || Range::finite().contains(-kInfinity));
  EXPECT_TRUE(Range::finite().contains(std::numeric_limits<double>::max()));
}

TEST(NumberText, ReadsBackAsTheSameNumber) {
  EXPECT_EQ(numberText(0.1), "0.1");
  EXPECT_EQ(numberText(10000.0), "10000");
  EXPECT_EQ(numberText(2147483647.0), "2147483647");
  EXPECT_EQ(numberText(-0.0004), "-0.0004");
  EXPECT_EQ(std::stod(numberText(M_PI)), M_PI);
  EXPECT_EQ(numberText(std::nan("")), "nan");
}

}  // namespace
}  // namespace laparoscope_servo::validation
