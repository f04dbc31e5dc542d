// What says that the scope must not move stops it, on the controller's next step.
#include <limits>

#include "stopping.h"

namespace laparoscope_servo {
namespace {

class ControllerStops : public Stopping {};

TEST_P(ControllerStops, AtOnce) {
  measure(10, [this] { return cart_.strike(GetParam().change); });
}

INSTANTIATE_TEST_SUITE_P(
    Causes, ControllerStops,
    ::testing::Values(
        Cause{"dead-man switch released", [](Feed& f) { f.pressed = false; }, "ARMED", "dead-man"},
        Cause{"robot disabled", [](Feed& f) { f.robot_state = "DISABLED"; }, "LOST",
              "not enabled: its state is DISABLED"},
        Cause{"robot in fault", [](Feed& f) { f.robot_state = "FAULT"; }, "LOST", "not enabled: its state is FAULT"},
        Cause{"robot in a state that is none", [](Feed& f) { f.robot_state = "DANCING"; }, "LOST", "not enabled"},
        Cause{"robot disabled and enabled, unheard", [](Feed& f) { f.enables = 2; }, "LOST", "enabled again"},
        Cause{"robot paused", [](Feed& f) { f.robot_state = "PAUSED"; }, "HOLD", "paused"},
        Cause{"task error beside any camera", [](Feed& f) { f.message.x = 50.0; }, "HOLD", "x or y is not within"},
        Cause{"task errors from the future", [](Feed& f) { f.stamp_offset = 0.5; }, "HOLD", "future"},
        Cause{"region lost", [](Feed& f) { f.message.valid = false; }, "HOLD", "not valid"},
        Cause{"region occluded", [](Feed& f) { f.message.visible_fraction = 0.1; }, "HOLD", "occluded"},
        Cause{"task error not finite", [](Feed& f) { f.message.x = std::numeric_limits<double>::quiet_NaN(); }, "HOLD",
              "not finite"},
        Cause{"d2 out of range", [](Feed& f) { f.d2 = 0.3; }, "HOLD", "d2 is not between"},
        Cause{"shaft off the insertion point", [](Feed& f) { f.lateral = 0.03; }, "FAULT",
              "passes the insertion point"},
        Cause{"stamps of the images jumped back", [](Feed& f) { f.stamp_offset = -1.0; }, "FAULT", "jumped back"}),
    indexOf);

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_stops");
  return RUN_ALL_TESTS();
}
