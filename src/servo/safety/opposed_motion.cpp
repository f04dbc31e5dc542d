#include "servo/safety/opposed_motion.h"

#include <cmath>

namespace laparoscope_servo::servo {

namespace {

const char* const kAxes[] = {"pan", "tilt", "spin", "insertion"};
constexpr double kLate = 0.1;    // s, by which the robot may be later than its delay; the effect guard allows 0.14 s
constexpr double kLasts = 0.15;  // s, least time for which an axis must move in the wrong direction
constexpr double kStep = 0.02;   // s, between the commands that are compared: the period of commands at 50 Hz

// Whether the motion opposes all commands since before its delay.
bool isOpposed(double time, double done, const CommandHistory& told, double delay, int axis) {
  for (double age = 0.0; age <= delay + kLate; age += kStep) {
    if (!(told.velocity(time, age)[axis] * done < 0.0)) return false;
  }
  return true;
}

}  // namespace

void OpposedMotion::restart() {
  opposed_.fill(false);
  words_.clear();
}

void OpposedMotion::report(double time, const scope::Velocity& done, const CommandHistory& told, double delay) {
  const Eigen::Vector4d velocity = done.vector();
  if (!words_.empty() || !velocity.allFinite() || !std::isfinite(time)) return;
  for (int k = 0; k < 4; ++k) {
    const bool moves = std::abs(velocity[k]) > 2.0 * width_.vector()[k];
    const bool opposed = moves && isOpposed(time, velocity[k], told, delay, k);
    if (opposed && (!opposed_[k] || time < since_[k])) since_[k] = time;
    opposed_[k] = opposed;
    if (opposed && time - since_[k] > kLasts)
      words_ = std::string("the robot says that its ") + kAxes[k] + " goes against what it is told";
  }
}

}  // namespace laparoscope_servo::servo
