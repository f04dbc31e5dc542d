#pragma once

namespace laparoscope_servo::servo {

// Of the estimate of the insertion point: how badly the robot's poses agree with one.
enum class ResidualLevel { kOk, kWarning, kStop };

}  // namespace laparoscope_servo::servo
