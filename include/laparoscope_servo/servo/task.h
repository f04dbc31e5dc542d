// The tasks: what moves the scope in SERVO.
#pragma once

namespace laparoscope_servo::servo {

enum class Task {
  kHoldView,   // the control law, which keeps the region of interest at its place in the image
  kManual,     // a person, by four velocities; images are not used
  kStabilise,  // the control law, which keeps the whole view where it was in the anchor image
  kCentreTip,  // the control law, which brings an instrument's tip back where it leaves a zone of the image
  kFollow,     // the control law, which keeps a moving object in the middle by its own dominant motion
  kPoints,     // the control law on points of texture, which brings each of them to its desired place
  kPosition,   // the control law, which brings the region back by its homography: 2 1/2 D
  kParallel,   // a small circle that measures the tissue's slant, then the control law, which turns the view onto it
};

constexpr Task kTasks[] = {Task::kHoldView, Task::kManual, Task::kStabilise, Task::kCentreTip,
                           Task::kFollow,   Task::kPoints, Task::kPosition,  Task::kParallel};

}  // namespace laparoscope_servo::servo
