#include "laparoscope_servo/aesop/command_guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace laparoscope_servo::aesop {
namespace {

const scope::Velocity kPan{0.05, 0.0, 0.0, 0.0};

TEST(CommandGuard, nothingCommandedIsZero) {
  const CommandGuard guard{CommandConfig()};
  EXPECT_TRUE(guard.velocity(100.0).isZero());
  EXPECT_FALSE(guard.timedOut(100.0));
}

TEST(CommandGuard, commandFadesBeforeItTimesOut) {
  CommandGuard guard{CommandConfig()};
  EXPECT_EQ(guard.accept({0.05, -0.02, 0.01, 0.003}, 1000.0, 1000.02, 5.0), "");
  const Eigen::Vector4d full = guard.velocity(5.0).vector();
  EXPECT_EQ(guard.velocity(5.099).vector(), full);
  double last = 1.0;
  for (double now = 5.1; now < 5.2; now += 0.01) {
    const Eigen::Vector4d velocity = guard.velocity(now).vector();
    const double share = velocity[0] / full[0];
    EXPECT_LE(share, last);
    EXPECT_TRUE(velocity.isApprox(share * full, 1e-9)) << velocity.transpose();  // the direction is kept
    last = share;
  }
  EXPECT_NEAR(guard.velocity(5.15).pan, 0.025, 1e-9);
  EXPECT_FALSE(guard.timedOut(5.19));
  EXPECT_TRUE(guard.velocity(5.21).isZero());
  EXPECT_TRUE(guard.timedOut(5.21));
}

TEST(CommandGuard, notFiniteIsAnImmediateZero) {
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity()};
  for (const double value : bad) {
    for (int field = 0; field < 4; ++field) {
      CommandGuard guard{CommandConfig()};
      ASSERT_EQ(guard.accept(kPan, 1000.0, 1000.0, 5.0), "");
      scope::Velocity velocity;
      (field == 0   ? velocity.pan
       : field == 1 ? velocity.tilt
       : field == 2 ? velocity.spin
                    : velocity.insertion) = value;
      EXPECT_NE(guard.accept(velocity, 1000.04, 1000.04, 5.04), "");
      EXPECT_TRUE(guard.velocity(5.04).isZero());
      EXPECT_EQ(guard.refused(), 1u);
      EXPECT_EQ(guard.accept(kPan, 1000.08, 1000.08, 5.08), "") << "a good one is taken again";
    }
  }
}

TEST(CommandGuard, stampsHaveToAdvance) {
  CommandGuard guard{CommandConfig()};
  ASSERT_EQ(guard.accept(kPan, 1000.0, 1000.0, 5.0), "");
  for (int k = 1; k <= 10; ++k) {
    EXPECT_NE(guard.accept(kPan, 1000.0, 1000.0 + 0.04 * k, 5.0 + 0.04 * k), "") << "the same once more";
  }
  EXPECT_TRUE(guard.velocity(5.4).isZero()) << "repetitions do not keep a command alive";
  EXPECT_NE(guard.accept(kPan, 999.9, 1000.2, 5.2), "") << "an older one";
}

TEST(CommandGuard, stampsHaveToBeNearNow) {
  CommandGuard guard{CommandConfig()};
  EXPECT_NE(guard.accept(kPan, 1000.0, 1000.6, 5.0), "");
  EXPECT_NE(guard.accept(kPan, 1000.71, 1000.6, 5.0), "") << "from the future";
  EXPECT_NE(guard.accept(kPan, 1e9, 1000.6, 5.0), "");
  EXPECT_NE(guard.accept(kPan, std::numeric_limits<double>::infinity(), 1000.6, 5.0), "");
  EXPECT_EQ(guard.refused(Refusal::kAhead), 3u);
  EXPECT_NE(guard.accept(kPan, 0.0, 1000.0, 5.0), "") << "no stamp";
  EXPECT_NE(guard.accept(kPan, std::numeric_limits<double>::quiet_NaN(), 1000.0, 5.0), "");
  EXPECT_TRUE(guard.velocity(5.0).isZero());
  EXPECT_EQ(guard.accept(kPan, 1000.2, 1000.6, 5.0), "");
  EXPECT_EQ(guard.accept(kPan, 1000.69, 1000.6, 5.0), "") << "clocks may differ by so much";
}

TEST(CommandGuard, aZeroIsTakenWhateverItsStamp) {
  CommandGuard guard{CommandConfig()};
  ASSERT_EQ(guard.accept(kPan, 1000.0, 1000.0, 5.0), "");
  EXPECT_EQ(guard.accept({}, 0.0, 1000.02, 5.02), "");
  EXPECT_TRUE(guard.velocity(5.02).isZero());
}

TEST(CommandGuard, aZeroFromTheFarFutureDoesNotBlockWhatFollows) {
  CommandGuard guard{CommandConfig()};
  EXPECT_EQ(guard.accept({}, 1e9, 1000.0, 5.0), "");
  EXPECT_EQ(guard.accept(kPan, 1000.04, 1000.04, 5.04), "");
  EXPECT_EQ(guard.accept({}, 1000.4, 1000.06, 5.06), "") << "nor one that is nearer";
  EXPECT_EQ(guard.accept(kPan, 1000.08, 1000.08, 5.08), "");
}

TEST(CommandGuard, refusedStampsFromTheFutureBlockNothing) {
  CommandGuard guard{CommandConfig()};
  ASSERT_EQ(guard.accept(kPan, 1000.0, 1000.0, 5.0), "");
  for (int k = 1; k <= 10; ++k) EXPECT_NE(guard.accept(kPan, 1000.0 + k, 1000.0, 5.0), "");
  EXPECT_EQ(guard.accept(kPan, 1000.02, 1000.02, 5.02), "");
  EXPECT_EQ(guard.velocity(5.02).pan, kPan.pan);
}

// Set forward: what was stamped before is old. Set right again: what was stamped in between is ahead.
TEST(CommandGuard, aClockThatJumpsForwardAndBackStopsAndGoesOn) {
  CommandGuard guard{CommandConfig()};
  ASSERT_EQ(guard.accept(kPan, 1000.0, 1000.0, 5.0), "");
  EXPECT_NE(guard.accept(kPan, 1000.02, 4600.02, 5.02), "");
  EXPECT_TRUE(guard.velocity(5.3).isZero()) << "the last good one has run out";
  EXPECT_EQ(guard.accept(kPan, 4600.04, 4600.06, 5.34), "");
  EXPECT_NE(guard.accept(kPan, 4600.08, 1000.4, 5.36), "");
  EXPECT_TRUE(guard.velocity(5.36).isZero());
  EXPECT_EQ(guard.accept(kPan, 1000.42, 1000.42, 5.38), "");
}

// A flood from the one who may command is as good as its newest command.
TEST(CommandGuard, aFloodEndsWithItsLastCommand) {
  CommandGuard guard{CommandConfig()};
  double time = 0.0;
  for (int k = 0; k < 10000; ++k, time += 1e-4) ASSERT_EQ(guard.accept(kPan, 1000.0 + time, 1000.0 + time, time), "");
  EXPECT_EQ(guard.accept({}, 0.0, 1000.0 + time, time), "");
  EXPECT_TRUE(guard.velocity(time).isZero());
  EXPECT_TRUE(guard.velocity(time + 10.0).isZero());
}

TEST(CommandGuard, resetForgetsAndWantsNewerStamps) {
  CommandGuard guard{CommandConfig()};
  ASSERT_EQ(guard.accept(kPan, 1000.0, 1000.0, 5.0), "");
  guard.reset(1000.1);
  EXPECT_TRUE(guard.velocity(5.0).isZero());
  EXPECT_NE(guard.accept(kPan, 1000.05, 1000.12, 5.12), "") << "stamped before the reset";
  EXPECT_EQ(guard.accept(kPan, 1000.11, 1000.14, 5.14), "");
}

TEST(CommandGuard, forgottenIsZeroUntilTheNext) {
  CommandGuard guard{CommandConfig()};
  ASSERT_EQ(guard.accept(kPan, 1000.0, 1000.0, 5.0), "");
  guard.forget();
  EXPECT_TRUE(guard.velocity(5.0).isZero());
  EXPECT_NE(guard.accept(kPan, 1000.0, 1000.01, 5.01), "") << "a stamp counts once";
  EXPECT_EQ(guard.accept(kPan, 1000.04, 1000.04, 5.04), "");
  EXPECT_EQ(guard.velocity(5.04).pan, kPan.pan);
}

TEST(CommandGuard, clockSetBackStopsAndGoesOn) {
  CommandGuard guard{CommandConfig()};
  ASSERT_EQ(guard.accept(kPan, 1000.0, 1000.0, 5.0), "");
  EXPECT_NE(guard.accept(kPan, 499.9, 500.0, 5.04), "") << "stamped before the clock was set back";
  EXPECT_TRUE(guard.velocity(5.04).isZero());
  EXPECT_EQ(guard.accept(kPan, 500.04, 500.04, 5.08), "");
}

TEST(CommandGuard, standingClockStops) {  // simulated time without a clock: now is 0
  CommandGuard guard{CommandConfig()};
  EXPECT_NE(guard.accept(kPan, 1000.0, 0.0, 5.0), "");
  EXPECT_NE(guard.accept(kPan, 0.0, 0.0, 5.0), "");
}

TEST(CommandGuard, limitsKeepTheDirection) {
  CommandGuard guard{CommandConfig()};
  ASSERT_EQ(guard.accept({0.3, -0.15, 0.3, 0.03}, 1000.0, 1000.0, 5.0), "");
  const scope::Velocity velocity = guard.velocity(5.0);
  EXPECT_DOUBLE_EQ(velocity.pan, 0.15);
  EXPECT_DOUBLE_EQ(velocity.tilt, -0.075);
  EXPECT_DOUBLE_EQ(velocity.spin, 0.15);
  EXPECT_DOUBLE_EQ(velocity.insertion, 0.015);
  ASSERT_EQ(guard.accept({1e300, 0.0, 0.0, -1e300}, 1000.1, 1000.1, 5.1), "");
  EXPECT_LE(std::abs(guard.velocity(5.1).pan), 0.15);
  EXPECT_LE(std::abs(guard.velocity(5.1).insertion), 0.03);
  const double largest = std::numeric_limits<double>::max();
  ASSERT_EQ(guard.accept({largest, -largest, largest, largest}, 1000.2, 1000.2, 5.2), "");
  EXPECT_TRUE(guard.velocity(5.2).isFinite());
  EXPECT_LE(std::abs(guard.velocity(5.2).spin), 0.3);
}

TEST(CommandConfig, errorsAreNamed) {
  EXPECT_TRUE(validate(CommandConfig()).empty());
  CommandConfig config;
  config.timeout = config.max_stamp_age = config.max_stamp_lead = config.max_pan = config.max_tilt = config.max_spin =
      config.max_insertion = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(validate(config).size(), 7u);
  config = CommandConfig();
  config.timeout = 3.0;
  ASSERT_EQ(validate(config).size(), 1u);
  EXPECT_NE(validate(config)[0].find("timeout = 3"), std::string::npos);
}

}  // namespace
}  // namespace laparoscope_servo::aesop
