// Pictures that are older than their stamps, as of a driver that stamps what it reads from a buffer: the law predicts
// from the wrong moment, and the loop would swing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>

#include "support/simulated_cart.h"

namespace laparoscope_servo::servo {
namespace {

struct Outcome {
  ControllerState state = ControllerState::kIdle;
  std::string reason;
  double swing = 0.0;   // rad, of the scope in the last 3 s
  double offset = 0.0;  // px, of the region, in the end
};

// The task error of `lag` s ago comes with the stamp of now.
Outcome run(double lag, unsigned seed, double seconds) {
  test::SimulatedCart cart(ControllerConfig(), {0.14, 0.06, 0.1, 0.01}, seed);
  std::deque<TaskErrorInput> buffer;
  const auto images = static_cast<std::size_t>(std::lround(lag / 0.04));
  cart.interference.tracker = [&](TaskErrorInput& seen) {
    buffer.push_back(seen);
    seen = buffer.front();
    if (buffer.size() > images) buffer.pop_front();
  };
  cart.pass(1.0);
  EXPECT_EQ(cart.controller.engage(cart.input()), "");
  cart.pass(seconds - 3.0);
  const Eigen::Isometry3d late = cart.pose();
  Outcome outcome;
  for (const double end = cart.time() + 3.0; cart.time() < end; cart.step())
    outcome.swing = std::max(outcome.swing, cart.travel(late).angle);
  outcome.state = cart.output.state;
  outcome.reason = cart.output.reason;
  outcome.offset = cart.offset();
  return outcome;
}

class LatePicture : public ::testing::TestWithParam<unsigned> {};

TEST_P(LatePicture, IsBorneUpToATenthOfASecond) {
  for (const double lag : {0.0, 0.08}) {
    const Outcome outcome = run(lag, GetParam(), 12.0);
    EXPECT_EQ(outcome.state, ControllerState::kServo) << lag << " s: " << outcome.reason;
    EXPECT_LT(outcome.offset, 1.0) << lag;
    EXPECT_LT(outcome.swing, 1e-3) << lag;
  }
}

TEST_P(LatePicture, MakesTheLoopSlowerUpToAFifth) {
  for (const double lag : {0.12, 0.16, 0.2}) {
    const Outcome outcome = run(lag, GetParam(), 30.0);
    EXPECT_EQ(outcome.state, ControllerState::kServo) << lag << " s: " << outcome.reason;
    EXPECT_LT(outcome.offset, 1.0) << lag;
    EXPECT_LT(outcome.swing, 1e-3) << lag;
  }
}

TEST_P(LatePicture, IsAFaultBeyond) {
  for (const double lag : {0.24, 0.32, 0.4, 0.6, 0.8, 1.2}) {
    const Outcome outcome = run(lag, GetParam(), 6.0);
    EXPECT_TRUE(outcome.state == ControllerState::kFault || outcome.state == ControllerState::kLost) << lag;
    EXPECT_EQ(outcome.swing, 0.0) << lag;
    // One that is later than anything the scope has done since is as good as frozen.
    if (lag < 0.7) {
      EXPECT_NE(outcome.reason.find("older than its stamps say"), std::string::npos) << lag << ' ' << outcome.reason;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, LatePicture, ::testing::Range(1u, 4u));

}  // namespace
}  // namespace laparoscope_servo::servo
