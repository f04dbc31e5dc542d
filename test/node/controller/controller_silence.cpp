// Whoever falls silent stops the scope once its last words are too old.
#include "stopping.h"

namespace laparoscope_servo {
namespace {

class ControllerSilence : public Stopping {};

TEST_P(ControllerSilence, StopsTheScope) {
  measure(7, [this] { return cart_.fallSilent(GetParam().change); });
}

INSTANTIATE_TEST_SUITE_P(
    Causes, ControllerSilence,
    ::testing::Values(
        Cause{"dead-man switch silent, 200 ms", [](Feed& f) { f.dead_man = false; }, "ARMED", "silent"},
        Cause{"robot's state silent, 300 ms", [](Feed& f) { f.robot = false; }, "HOLD", "operating state is older"},
        Cause{"tracker silent, 250 ms", [](Feed& f) { f.task_error = false; }, "HOLD", "older than 0.25 s"},
        Cause{"images old, 250 ms", [](Feed& f) { f.images_stop = true; }, "HOLD",
              "image behind the task error is older"},
        Cause{"tf old, 250 ms", [](Feed& f) { f.tf = false; }, "HOLD", "depth d2 is older"}),
    indexOf);

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_silence");
  return RUN_ALL_TESTS();
}
