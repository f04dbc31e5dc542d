// How far the emulated arm has moved, by its true joints.
#pragma once

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/aesop/kinematics.h"

namespace laparoscope_servo::test {

struct Travel {
  double degrees = 0.0;      // the most of the turning joints
  double millimetres = 0.0;  // of the joints that slide
  double tip = 0.0;          // mm, of the camera

  void atLeast(const Travel& other) {
    degrees = std::max(degrees, other.degrees);
    millimetres = std::max(millimetres, other.millimetres);
    tip = std::max(tip, other.tip);
  }
};

inline Travel travel(const aesop::Kinematics& kinematics, const aesop::JointVector& from,
                     const aesop::JointVector& to) {
  Travel travel;
  for (int k = 0; k < aesop::kJoints; ++k) {
    const double change = std::abs(to[k] - from[k]);
    if (kinematics.config().joints[static_cast<std::size_t>(k)].prismatic) {
      travel.millimetres = std::max(travel.millimetres, 1e3 * change);
    } else {
      travel.degrees = std::max(travel.degrees, change * 180.0 / M_PI);
    }
  }
  travel.tip = 1e3 * (kinematics.optical(to).translation() - kinematics.optical(from).translation()).norm();
  return travel;
}

}  // namespace laparoscope_servo::test
