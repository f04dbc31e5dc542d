#pragma once

namespace laparoscope_servo::servo {

// Level of the residual of the insertion point: how badly the robot's poses agree with one point.
enum class ResidualLevel { kOk, kWarning, kStop };

}  // namespace laparoscope_servo::servo
