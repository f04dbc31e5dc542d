// How far the scope goes on while it pans at its limit of speed, when images stop coming or their stamps lose time: the
// arm's delay and its braking are included.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "support/simulated_cart.h"
#include "support/slow_stamps.h"

namespace laparoscope_servo::servo {
namespace {

using Change = std::function<void(ControllerInput&)>;

// Degrees, the most of 24 starts that differ in the phase of the fault; `lag` [s]: by which the arm is later from the
// fault on.
double furthest(const std::function<Change()>& fault, double lag = 0.0) {
  double most = 0.0;
  for (unsigned seed = 1; seed <= 24; ++seed) {
    test::SimulatedCart cart(ControllerConfig(), {0.15, 0.02, 0.0, 0.0}, seed);
    cart.pass(0.5);
    EXPECT_EQ(cart.controller.engage(cart.input()), "");
    cart.pass(0.45 + 0.01 * seed);
    EXPECT_EQ(cart.output.caution, "");
    EXPECT_GT(std::abs(cart.velocity()[0]), 0.09);
    cart.lag = lag;
    const Eigen::Isometry3d from = cart.pose();
    cart.interference.input = [change = fault()](ControllerInput& input, double) { change(input); };
    for (const double end = cart.time() + 1.5; cart.time() < end;) {
      cart.step();
      most = std::max(most, cart.travel(from).angle);
    }
    EXPECT_TRUE(cart.velocity().isZero(0.0));
  }
  return most * 180.0 / M_PI;
}

Change silent() {
  return [last = std::optional<TaskErrorInput>()](ControllerInput& input) mutable {
    if (!last) last = input.task_error;
    input.task_error = *last;
    input.task_error.age = input.task_error.image_age = input.time - *last->image_time;
  };
}

TEST(SilentCamera, StopsTheScopeByThePeriodOfItsImages) {
  EXPECT_LT(furthest(silent), 1.6);
}

// While it moves at one speed nothing shows that the arm is later: 0.46 s at the limit of 5.7 degrees a second remain.
TEST(SilentCamera, TogetherWithAnArmThatIsLater) {
  EXPECT_LT(furthest(silent, 0.3), 3.2);
}

TEST(SilentCamera, StampsThatLoseTimeStopTheScopeBeforeItsImagesAreOld) {
  EXPECT_LT(furthest([] { return test::SlowStamps(0.5); }), 1.9);
  EXPECT_LT(furthest([] { return test::SlowStamps(0.75); }), 3.0);
}

}  // namespace
}  // namespace laparoscope_servo::servo
