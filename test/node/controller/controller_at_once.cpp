// What a message says that ends the motion does not wait for the controller's next step: here there are 0.1 s between
// two of them.
#include <algorithm>

#include "stopping.h"

namespace laparoscope_servo {
namespace {

class ControllerAtOnce : public Stopping {};

TEST_P(ControllerAtOnce, StopsBetweenTwoSteps) {
  constexpr int kRepetitions = 9;
  ASSERT_TRUE(cart_.waitForController());
  std::vector<double> times;
  for (int k = 0; k < kRepetitions; ++k) {
    ASSERT_NO_FATAL_FAILURE(move());
    waitForAPhase(k, kRepetitions, 100);
    ASSERT_NO_FATAL_FAILURE(expectStop([this] { return cart_.strike(GetParam().change); }, times));
  }
  printStoppingTimes(GetParam().name, GetParam().state, times);
  std::sort(times.begin(), times.end());
  EXPECT_LT(times[kRepetitions / 2], 0.025);  // the steps alone: 0.05 s
}

INSTANTIATE_TEST_SUITE_P(
    Causes, ControllerAtOnce,
    ::testing::Values(Cause{"dead-man switch released", [](Feed& f) { f.pressed = false; }, "ARMED", "dead-man"},
                      Cause{"robot disabled", [](Feed& f) { f.robot_state = "DISABLED"; }, "LOST", "DISABLED"},
                      Cause{"region lost", [](Feed& f) { f.message.valid = false; }, "HOLD", "not valid"}),
    indexOf);

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_at_once");
  return RUN_ALL_TESTS();
}
